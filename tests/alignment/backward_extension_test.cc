#include "alignment/backward_extension.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "alignment/start_layout.h"
#include "imu/imu_link.h"
#include "io/config/scenario_config.h"
#include "measurements/noise_kind.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

class BackwardExtension : public ::testing::Test {
 protected:
  BackwardExtension() {
    Scenario scenario = FindScenario("flight");
    scenario.duration = 60.0;
    dataset_ = Simulate(scenario, 4);
    NavigationPrior prior;
    prior.position_sigma.setConstant(1.0);
    prior.velocity_sigma.setConstant(0.1);
    prior.attitude_sigma.setConstant(0.01);
    prior.gyro_bias_sigma.setConstant(1e-5);
    prior.accel_bias_sigma.setConstant(1e-2);
    layout_ = BuildLayout(dataset_, prior);
    const TruthPoint truth = dataset_.truth[300];
    x_.t = truth.t;
    x_.p_e = *truth.p_e;
    x_.v_e = x_.C_en() * *truth.v_n;
    x_.q_eb = Eigen::Quaterniond(x_.C_en()) * *truth.q_nb;
    x_.b_g = Eigen::Vector3d(1e-5, -2e-5, 3e-5);
    x_.parameters = InitialParameters(dataset_, layout_);
  }

  Dataset dataset_;
  ErrorLayout layout_;
  State x_;
};

TEST_F(BackwardExtension, PredictingForwardAgainGivesTheStateBack) {
  ImuIntegrator integrator(dataset_.imu);
  const ImuSummary summary =
      integrator.Summarize(x_.t - 1.0, x_.t, CalibrationOf(layout_, x_));
  const State back = PredictBackward(layout_, x_, summary);
  EXPECT_NEAR(back.t, x_.t - 1.0, 1e-12);
  const ErrorVector d = Local(layout_, x_, Predict(layout_, back, summary));
  EXPECT_LT(d.cwiseAbs().maxCoeff(), 1e-8);
}

TEST_F(BackwardExtension, AFilterArrivesWithAtLeastTheOldCovariance) {
  Prior prior{x_, layout_.InitialCovariance()};
  const Prior old = prior;
  ExtendBackward(layout_, dataset_.imu, 20.0, &prior);
  EXPECT_NEAR(prior.x.t, 20.0, 1e-9);
  ImuIntegrator integrator(dataset_.imu);
  ErrorMatrix P = prior.P;
  ErrorMatrix Q = ErrorMatrix::Zero(P.rows(), P.cols());
  State x = prior.x;
  Transition transition;
  transition.c = ErrorVector::Zero(layout_.dim());
  while (x.t < old.x.t - 1e-9) {
    const ImuSummary summary =
        integrator.Summarize(x.t, x.t + 1.0, CalibrationOf(layout_, x));
    const State next = Predict(layout_, x, summary);
    LinearizeTransition(layout_, summary, x, next, &transition);
    P = transition.Phi * P * transition.Phi.transpose();
    Q = transition.Phi * Q * transition.Phi.transpose() + transition.Q;
    x = next;
  }
  EXPECT_LT(Local(layout_, old.x, x).cwiseAbs().maxCoeff(), 1e-5);
  // Carried there and back without the noise of the way forward, what remains
  // on top of the old covariance is the noise of the way back.
  const ErrorMatrix excess = P - old.P - Q;
  EXPECT_LT(excess.cwiseAbs().maxCoeff(),
            1e-3 * Q.diagonal().maxCoeff() + 1e-9);
}

TEST_F(BackwardExtension, StopsWhereNothingIsKnownAnyMore) {
  Prior prior{x_, layout_.InitialCovariance()};
  const int g = layout_.Find(BlockKind::kGyroBias)->offset;
  prior.P.block<3, 3>(g, g) = Eigen::Matrix3d::Identity() * 0.05 * 0.05;
  ExtendBackward(layout_, dataset_.imu, 0.0, &prior);
  EXPECT_GT(prior.x.t, 20.0);
  EXPECT_LT(prior.x.t, 25.0);
}

/// Exact inference on one interval: what is known at its begin is the standing
/// covariance of what forgets and nothing of the rest, and P_j at its end.
ErrorMatrix Inferred(const ErrorMatrix& V_i, const Transition& transition,
                     const ErrorMatrix& P_j) {
  const Eigen::MatrixXd V = V_i;
  const Eigen::MatrixXd Phi = transition.Phi;
  const Eigen::MatrixXd V_j = Phi * V * Phi.transpose() + transition.Q;
  const Eigen::MatrixXd G =
      V * Phi.transpose() *
      V_j.ldlt().solve(Eigen::MatrixXd::Identity(V.rows(), V.cols()));
  return V - G * (V_j - P_j) * G.transpose();
}

class ForgettingBlocks : public BackwardExtension {
 protected:
  /// Gauss-Markov gyro biases and, of the receiver, errors that last 0.1 s.
  ForgettingBlocks() {
    dataset_.imu.noise.gyro_bias_walk = 1e-4;
    dataset_.imu.noise.gyro_bias_tau = 0.5;
    Sensor& receiver = dataset_.streams.front().sensor;
    receiver.noise = {&GaussMarkovNoise(), 2.0, 0.1, 0.1};
    NavigationPrior prior;
    prior.position_sigma.setConstant(1.0);
    prior.velocity_sigma.setConstant(0.1);
    prior.attitude_sigma.setConstant(0.01);
    prior.gyro_bias_sigma.setConstant(1e-4 * std::sqrt(0.25));
    prior.accel_bias_sigma.setConstant(1e-2);
    prior.gyro_bias = dataset_.imu.noise.GyroBiasEvolution();
    layout_ = BuildLayout(dataset_, prior);
    x_.b_g.setZero();
    x_.parameters = InitialParameters(dataset_, layout_);
  }
};

TEST_F(ForgettingBlocks, AreCarriedBackAsExactInferenceDoes) {
  constexpr double kStep = 0.25;
  const ErrorMatrix P_j = [&] {
    ErrorMatrix P = layout_.InitialCovariance();
    const int g = layout_.Find(BlockKind::kGyroBias)->offset;
    P.block<3, 3>(g, g) *= 0.3;  // something is known of it at the end
    P(g, 6) = P(6, g) = 0.4 * std::sqrt(P(g, g) * P(6, 6));
    return P;
  }();
  Prior prior{x_, P_j};
  ExtendBackward(layout_, dataset_.imu, x_.t - kStep, &prior);
  ImuIntegrator integrator(dataset_.imu);
  const ImuSummary summary =
      integrator.Summarize(x_.t - kStep, x_.t, CalibrationOf(layout_, prior.x));
  Transition transition;
  LinearizeTransition(layout_, summary, prior.x, x_, &transition);
  ErrorMatrix V = layout_.InitialCovariance();
  V.diagonal().head<9>() *= 1e6;
  V.diagonal().segment<3>(12) *= 1e6;
  const ErrorMatrix expected = Inferred(V, transition, P_j);
  for (int i = 0; i < layout_.dim(); ++i) {
    for (int j = 0; j < layout_.dim(); ++j) {
      EXPECT_NEAR(prior.P(i, j), expected(i, j),
                  1e-4 * std::sqrt(expected(i, i) * expected(j, j)))
          << layout_.ComponentName(i) << ", " << layout_.ComponentName(j);
    }
  }
}

TEST_F(ForgettingBlocks, KeepTheirStationaryCovariance) {
  Prior prior{x_, layout_.InitialCovariance()};
  ExtendBackward(layout_, dataset_.imu, 20.0, &prior);
  EXPECT_NEAR(prior.x.t, 20.0, 1e-9);
  ASSERT_TRUE(prior.P.allFinite());
  for (const BlockKind kind : {BlockKind::kColouredNoise}) {
    const Block* block = layout_.Find(kind, 0);
    ASSERT_NE(block, nullptr);
    for (int i = block->offset; i < block->offset + block->dim; ++i) {
      EXPECT_NEAR(prior.P(i, i), 4.0, 1e-9);
      ErrorVector others = prior.P.row(i);
      others(i) = 0.0;
      EXPECT_LT(others.cwiseAbs().maxCoeff(), 1e-9);
    }
  }
  const int g = layout_.Find(BlockKind::kGyroBias)->offset;
  EXPECT_NEAR(prior.P(g, g), 1e-8 * 0.25, 1e-12);
}

TEST_F(BackwardExtension, ACountBeginsAtItsFirstReading) {
  AidingStream& odometer = dataset_.streams.emplace_back();
  odometer.sensor.name = "wheel";
  odometer.sensor.kind = &OdometerKind();
  odometer.sensor.count_sigma = 0.01;
  Odometer increment;
  increment.form = Odometer::Form::kIncrements;
  odometer.measurements.push_back({1.0, 1, false, increment});
  NavigationPrior prior_sigmas;
  prior_sigmas.position_sigma.setConstant(1.0);
  prior_sigmas.velocity_sigma.setConstant(0.1);
  prior_sigmas.attitude_sigma.setConstant(0.01);
  prior_sigmas.gyro_bias_sigma.setConstant(1e-5);
  prior_sigmas.accel_bias_sigma.setConstant(1e-2);
  layout_ = BuildLayout(dataset_, prior_sigmas);
  x_.parameters = InitialParameters(dataset_, layout_);
  Prior prior{x_, layout_.InitialCovariance()};
  ExtendBackward(layout_, dataset_.imu, 20.0, &prior);
  EXPECT_NEAR(prior.x.t, 20.0, 1e-9);
  ASSERT_TRUE(prior.P.allFinite());
  const Block* error = layout_.Find(BlockKind::kOffset, 1);
  const Block* distance = layout_.Find(BlockKind::kDistance, 1);
  ASSERT_TRUE(error != nullptr && distance != nullptr);
  EXPECT_NEAR(prior.P(error->offset, error->offset), 1e-4, 1e-12);
  EXPECT_NEAR(prior.P(distance->offset, distance->offset), 1.0, 1e-12);
  EXPECT_EQ(prior.x.parameters(distance->parameter_offset), 0.0);
}

}  // namespace
}  // namespace hindsight
