#include "alignment/backward_extension.h"

#include <gtest/gtest.h>

#include "alignment/start_layout.h"
#include "imu/imu_link.h"
#include "simulation/builtin_scenarios.h"

namespace hindsight {
namespace {

class BackwardExtension : public ::testing::Test {
 protected:
  BackwardExtension() {
    Scenario scenario = BuiltinScenario("flight");
    scenario.duration = 60.0;
    dataset_ = Simulate(scenario, 4);
    NavigationPrior prior;
    prior.position_sigma.setConstant(1.0);
    prior.velocity_sigma.setConstant(0.1);
    prior.attitude_sigma.setConstant(0.01);
    prior.gyro_bias_sigma.setConstant(1e-5);
    prior.accel_bias_sigma.setConstant(1e-2);
    layout_ = BuildLayout(dataset_, prior);
    const TruthPoint& truth = dataset_.truth[300];
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

}  // namespace
}  // namespace hindsight
