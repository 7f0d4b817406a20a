#include "attitude/attitude_smoother.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "attitude/attitude_samples.h"
#include "base/random.h"
#include "earth/wgs84.h"
#include "filters/rts.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

const Eigen::Vector3d kSmoothedFieldNed(20.0, 0.0, 40.0);
constexpr double kSmoothedStep = 0.02;

/// A body that turns for ten seconds and then rests for five, with noise in
/// every reading.
struct Turning {
  ImuStream imu;
  std::vector<MagneticSample> magnetic;
  std::vector<Eigen::Quaterniond> q_nb;
  Eigen::Vector3d b_g = {0.01, -0.02, 0.015};
  AttitudeFilterOptions options;
  AttitudeState start;

  Turning() {
    Random random(4);
    Eigen::Quaterniond q = Exp(Eigen::Vector3d(0.2, -0.1, 0.7));
    Eigen::Vector3d before = Eigen::Vector3d::Zero();
    for (int k = 0; k <= 750; ++k) {
      const double t = k * kSmoothedStep;
      const bool rests = t > 10.0;
      const Eigen::Vector3d w =
          rests ? Eigen::Vector3d::Zero() : Eigen::Vector3d(0.9, -0.6, 1.2);
      // Rates are linear between samples.
      if (k > 0) q = q * Exp(0.5 * kSmoothedStep * (before + w));
      before = w;
      q_nb.push_back(q);
      imu.samples.push_back(
          {t, w + b_g + 1e-3 * random.NormalVector3(),
           q.conjugate() * Eigen::Vector3d(0.0, 0.0, -options.place.gravity) +
               0.1 * random.NormalVector3()});
      magnetic.push_back(
          {t, q.conjugate() * kSmoothedFieldNed + random.NormalVector3()});
    }
    imu.noise.gyro_noise_density = 1e-3;
    imu.noise.gyro_bias_walk = 1e-4;
    imu.noise.gyro_bias_tau = 1000.0;
    imu.noise.accel_bias_walk = 1e-3;
    imu.noise.accel_bias_tau = 100.0;
    options.magnetic_form = MagneticField::Form::kVector;
    options.magnetic.horizontal = kSmoothedFieldNed.x();
    options.magnetic.down = kSmoothedFieldNed.z();
    options.reference.enabled = false;
    options.update_interval = 5.0 * kSmoothedStep;
    options.rest_sigma = 0.01;
    options.dip_sigma = 0.1;
    start.q_nb = Exp(Eigen::Vector3d(0.05, -0.05, 0.1)) * q_nb.front();
    start.P.diagonal() << Eigen::Vector3d::Constant(0.01),
        Eigen::Vector3d::Constant(4e-4), Eigen::Vector3d::Constant(1.6e-5),
        Eigen::Vector3d::Constant(1e-2), 0.0;
  }
  AttitudeRun Run() const {
    return RunAttitudeFilter(imu, {magnetic}, options, start,
                             /*to_be_smoothed=*/true);
  }
};

/// The same system on a tape.
LinearTape TapeOf(const Turning& turning, const AttitudeRun& run) {
  ErrorLayout layout = AttitudeLayout(turning.imu.noise, turning.start);
  // The dip of the field has no kind of its own.
  Block dip;
  dip.key = {BlockKind::kDeclination};
  dip.name = "dip";
  dip.evolution = Evolution::Constant();
  dip.sigma0.setConstant(turning.options.dip_sigma);
  layout.Add(dip);
  LinearTape tape(layout);
  const Eigen::Quaterniond q_en(NedAxes(turning.options.place.p_e));
  AttitudeState::Matrix P = turning.start.P;
  P(AttitudeState::kDip, AttitudeState::kDip) =
      std::pow(turning.options.dip_sigma, 2);
  for (const AttitudeNode& node : run.nodes) {
    Transition transition;
    constexpr int kDim = AttitudeState::kDim;
    constexpr int kGyro = AttitudeState::kGyroBias;
    constexpr int kAccel = AttitudeState::kAccelBias;
    const AttitudeTransition& step = node.transition;
    transition.Phi.setIdentity(kDim, kDim);
    transition.Phi.block<3, 6>(0, kGyro) = step.A;
    transition.Phi.diagonal().segment<3>(kGyro).setConstant(step.phi);
    transition.Phi.diagonal().segment<3>(kAccel).setConstant(step.phi_accel);
    transition.Q.setZero(kDim, kDim);
    transition.Q.diagonal().head<3>().setConstant(step.q_attitude);
    transition.Q.diagonal().segment<3>(kGyro).setConstant(step.q_bias);
    transition.Q.diagonal().segment<3>(kAccel).setConstant(step.q_accel_bias);
    if (step.learns_dip) {
      transition.Phi.row(AttitudeState::kDip) =
          step.dip_by_psi.transpose() * transition.Phi.topRows<3>();
      transition.Q(AttitudeState::kDip, AttitudeState::kDip) = step.q_dip;
    }
    transition.c = ErrorVector::Zero(kDim);
    P = transition.Phi * P * transition.Phi.transpose() + transition.Q;
    TapeEpoch epoch;
    epoch.t = node.x.t;
    epoch.c = epoch.dx_minus = ErrorVector::Zero(kDim);
    // About one nominal an update: the mean stays, nothing is reset.
    epoch.dx_plus = ErrorVector::Zero(kDim);
    epoch.x_plus.t = node.x.t;
    epoch.x_plus.p_e = turning.options.place.p_e;
    epoch.x_plus.q_eb = q_en * node.x.q_nb;
    epoch.x_plus.b_g = node.x.b_g;
    epoch.x_plus.b_a = node.x.b_a;
    epoch.x_plus.parameters = Eigen::Vector4d::Zero();
    epoch.x_plus.parameters.head<3>() = node.x.s_g;
    epoch.x_minus = epoch.x_plus;
    epoch.reset = true;
    tape.Append(epoch, transition, P, node.x.P);
    P = node.x.P;
  }
  return tape;
}

/// Whether the reference of the field is learned.
class AttitudeSmootherOf : public ::testing::TestWithParam<bool> {
 protected:
  AttitudeSmootherOf() {
    turning.options.reference.enabled = GetParam();
    turning.options.magnetic_correlation_time = 1.0;
    run = turning.Run();
  }
  Turning turning;
  AttitudeRun run;
};

TEST_P(AttitudeSmootherOf, HasTheCovarianceOfRauchTungAndStriebel) {
  EXPECT_EQ(std::any_of(run.nodes.begin(), run.nodes.end(),
                        [](const AttitudeNode& node) {
                          return node.transition.learns_dip;
                        }),
            GetParam());
  const std::vector<SmoothedAttitude> smoothed = SmoothAttitude(run);
  const SmoothedTrajectory rts = SmoothRts(TapeOf(turning, run));
  ASSERT_EQ(smoothed.size(), rts.states.size());
  for (std::size_t k = 0; k < smoothed.size(); ++k) {
    const AttitudeState::Matrix P = rts.P.Get(k);
    const AttitudeState::Vector sigma = P.diagonal().cwiseSqrt();
    const AttitudeState::Matrix relative =
        (smoothed[k].P - P).cwiseQuotient(sigma * sigma.transpose());
    EXPECT_LT(relative.cwiseAbs().maxCoeff(), 1e-7) << k;
  }
}

/// d(k) = P Phi' (P-)^-1 (d(k+1) + dx(k+1)) of the node after.
TEST_P(AttitudeSmootherOf, HasTheMeanOfRauchTungAndStriebel) {
  const std::vector<SmoothedAttitude> smoothed =
      SmoothAttitude(run, /*covariances=*/false);
  const LinearTape tape = TapeOf(turning, run);
  AttitudeState::Vector d = AttitudeState::Vector::Zero();
  for (std::size_t k = run.nodes.size() - 1; k-- > 0;) {
    const AttitudeState::Matrix P_minus = tape.P_minus(k + 1);
    d = run.nodes[k].x.P * tape.Phi(k + 1).transpose() *
        P_minus.llt().solve(d + run.nodes[k + 1].dx);
    const AttitudeState::Vector sigma = run.nodes[k].x.P.diagonal().cwiseSqrt();
    EXPECT_LT((smoothed[k].d - d).cwiseQuotient(sigma).norm(), 1e-7) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Reference, AttitudeSmootherOf, ::testing::Bool());

/// What a bias of the accelerometer does to the averages is linear in it.
TEST(AveragedForce, SaysWhatABiasAddsToIt) {
  Turning turning;
  const Eigen::Vector3d b_a(0.3, -0.2, 0.1);
  const auto without = AveragedForce(turning.imu, turning.q_nb, 0.5);
  for (ImuSample& sample : turning.imu.samples) sample.accel += b_a;
  const auto with = AveragedForce(turning.imu, turning.q_nb, 0.5);
  for (std::size_t k = 0; k < with.size(); k += 50) {
    EXPECT_LT((with[k].rightCols<3>() - without[k].rightCols<3>()).norm(),
              1e-12);
    EXPECT_LT(
        (with[k].col(0) - without[k].col(0) - without[k].rightCols<3>() * b_a)
            .norm(),
        1e-12);
  }
  // While it turns a part of the bias averages out.
  EXPECT_LT(with[250].rightCols<3>().norm(), 0.99 * std::sqrt(3.0));
}

TEST(AttitudeSmoother, UndoesTheErrorOfTheStart) {
  const Turning turning;
  const AttitudeRun run = turning.Run();
  const std::vector<SmoothedAttitude> smoothed = SmoothAttitude(run);
  const AttitudeState last = StateOf(run, smoothed, run.nodes.size() - 1);
  EXPECT_EQ(last.b_g, run.nodes.back().x.b_g);
  const AttitudeState first = StateOf(run, smoothed, 0);
  EXPECT_GT(turning.start.q_nb.angularDistance(turning.q_nb.front()), 0.1);
  EXPECT_LT(first.q_nb.angularDistance(turning.q_nb.front()), 0.01);
  EXPECT_LT((first.b_g - turning.b_g).norm(), 2e-3);
}

TEST(AttitudeSmoother, FollowsTheGyrosFromNodeToNode) {
  const Turning turning;
  const AttitudeRun run = turning.Run();
  const std::vector<SmoothedAttitude> smoothed = SmoothAttitude(run);
  const std::vector<Eigen::Quaterniond> q_nb =
      AttitudesAtSamples(run, smoothed, turning.imu);
  ASSERT_EQ(q_nb.size(), turning.imu.samples.size());
  for (std::size_t k = 0; k < q_nb.size(); ++k) {
    const std::size_t node = run.samples[k].node;
    if (k % 5 == 0) {
      EXPECT_LT(q_nb[k].angularDistance(StateOf(run, smoothed, node).q_nb),
                1e-9);
    }
    if (k == 0) continue;
    // No step where a node begins, but for the gyros' noise and turn.
    const Eigen::Quaterniond turn = q_nb[k - 1].conjugate() * q_nb[k];
    const Eigen::Quaterniond truth =
        turning.q_nb[k - 1].conjugate() * turning.q_nb[k];
    EXPECT_LT(turn.angularDistance(truth), 1e-3) << k;
  }
}

}  // namespace
}  // namespace hindsight
