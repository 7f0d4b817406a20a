#include <gtest/gtest.h>

#include <array>

#include "attitude/attitude_run.h"
#include "base/random.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

/// A body that turns and is thrown about, without noise, and what a receiver
/// beside the IMU says of its velocity.
struct Thrown {
  ImuStream imu;
  std::vector<VelocitySample> velocities;
  AttitudeFilterOptions options;
  AttitudeState start;
  std::vector<Eigen::Quaterniond> q_nb;

  Thrown() {
    constexpr double kStep = 2.5e-4;
    constexpr int kSteps = 16000;
    const Eigen::Vector3d lever_arm(0.4, -0.3, 0.2);
    const Eigen::Vector3d g_n(0.0, 0.0, options.place.gravity);
    Eigen::Quaterniond q = Exp(Eigen::Vector3d(0.3, -0.2, 2.0));
    Eigen::Vector3d w_before = Eigen::Vector3d::Zero();
    for (int k = 0; k <= kSteps; ++k) {
      const double t = k * kStep;
      const Eigen::Vector3d w(0.5 * std::sin(t), 0.4, -0.6 * std::cos(2.0 * t));
      if (k > 0) q = q * Exp(0.5 * kStep * (w_before + w));
      w_before = w;
      const Eigen::Vector3d v_n(3.0 * std::sin(t), 2.0 * t, std::cos(1.5 * t));
      const Eigen::Vector3d a_n(3.0 * std::cos(t), 2.0,
                                -1.5 * std::sin(1.5 * t));
      imu.samples.push_back({t, w, q.conjugate() * (a_n - g_n)});
      q_nb.push_back(q);
      if (k % 2000 != 0) continue;
      velocities.push_back({t, v_n + q * w.cross(lever_arm),
                            Eigen::Vector3d(0.001, 0.002, 0.003).asDiagonal(),
                            lever_arm});
    }
    imu.noise.gyro_noise_density = 1e-4;
    imu.noise.accel_noise_density = 1e-3;
    options.rule.sigma = 0.5;
    options.update_interval = 0.25;
    start.q_nb = q_nb.front();
    start.P.diagonal() << Eigen::Vector3d::Constant(9e-4),
        Eigen::Vector3d::Constant(1e-4), Eigen::Vector3d::Constant(1e-6),
        Eigen::Vector3d::Constant(1e-12), 0.0;
  }

  AttitudeRun Run(const AttitudeState& from) const {
    return RunAttitudeFilter(imu, {.velocities = velocities}, options, from,
                             /*to_be_smoothed=*/true);
  }
};

/// Of whole seconds: two and more apart by less count for nothing.
TEST(VelocityOfAnAttitude, IsUsedOnceASecond) {
  const Thrown thrown;
  EXPECT_EQ(thrown.Run(thrown.start).updates.size(), 4u * 3u);
}

TEST(VelocityOfAnAttitude, ExplainsNoiselessReadings) {
  const Thrown thrown;
  const AttitudeRun run = thrown.Run(thrown.start);
  for (const ScalarUpdate& update : run.updates) {
    EXPECT_NEAR(update.innovation, 0.0, 1e-5);
  }
  const AttitudeSample& last = run.samples.back();
  EXPECT_LT(Log(last.q_nb * thrown.q_nb.back().conjugate()).norm(), 1e-5);
}

/// What is recorded of the first interval against differences of its residuals
/// by a start that is off.
TEST(VelocityOfAnAttitude, HasTheJacobianOfItsResidual) {
  const Thrown thrown;
  const AttitudeRun right = thrown.Run(thrown.start);
  constexpr double kOff = 1e-5;
  for (const int i : {0, 1, 2, 3, 4, 5, 9, 10, 11}) {
    std::array<AttitudeRun, 2> off;
    for (const int side : {0, 1}) {
      AttitudeState from = thrown.start;
      const double step = side == 0 ? -kOff : kOff;
      if (i < 3) {
        from.q_nb = Exp(step * Eigen::Vector3d::Unit(i)) * from.q_nb;
      } else if (i < AttitudeState::kGyroScale) {
        from.b_g(i - AttitudeState::kGyroBias) += step;
      } else {
        from.b_a(i - AttitudeState::kAccelBias) += step;
      }
      off[static_cast<std::size_t>(side)] = thrown.Run(from);
    }
    // The residual of the first row has no other before it. Its derivative by
    // the state at the start goes through the transitions up to its node.
    AttitudeState::Vector d = AttitudeState::Vector::Unit(i);
    for (std::size_t k = 0;
         right.nodes[k].updates_end == 0 || right.nodes[k - 1].updates_end == 0;
         ++k) {
      d.head<3>() +=
          right.nodes[k].transition.A * d.segment<6>(AttitudeState::kGyroBias);
      if (right.nodes[k].updates_end > 0) break;
    }
    const double numeric =
        (off[1].updates[0].innovation - off[0].updates[0].innovation) /
        (2.0 * kOff);
    EXPECT_NEAR(-right.updates[0].h.dot(d), numeric,
                1e-3 * right.updates[0].h.norm())
        << i;
  }
}

/// An attitude that is off comes right, its heading too, with sigmas that say
/// so: errors over sigmas of 200 bodies, a chi-square of 600.
TEST(VelocityOfAnAttitude, FindsTiltAndHeading) {
  Thrown thrown;
  Random random(11);
  double nees = 0.0;
  constexpr int kBodies = 200;
  for (int body = 0; body < kBodies; ++body) {
    Thrown noisy = thrown;
    Eigen::Matrix<double, 6, 1> d;
    d << 0.03 * random.NormalVector3(), 0.01 * random.NormalVector3();
    noisy.start.q_nb = Exp(-d.head<3>()) * thrown.start.q_nb;
    for (ImuSample& sample : noisy.imu.samples) sample.gyro += d.tail<3>();
    noisy.start.P.diagonal()
        .segment<3>(AttitudeState::kGyroScale)
        .setConstant(1e-12);
    for (VelocitySample& one : noisy.velocities) {
      one.v_n +=
          one.R_n.diagonal().cwiseSqrt().cwiseProduct(random.NormalVector3());
    }
    const AttitudeRun run = noisy.Run(noisy.start);
    const AttitudeState& last = run.nodes.back().x;
    const Eigen::Vector3d psi = Log(thrown.q_nb.back() * last.q_nb.conjugate());
    const Eigen::Matrix3d P = last.P.topLeftCorner<3, 3>();
    EXPECT_LT(P(2, 2), thrown.start.P(2, 2));
    nees += psi.dot(P.llt().solve(psi));
  }
  // Sigmas are a little too large, as neighbouring intervals share an error:
  // never too small (99.9 % of chi-square with 600 degrees of freedom).
  EXPECT_LT(nees / kBodies, 3.56);
  EXPECT_GT(nees / kBodies, 1.5);
}

}  // namespace
}  // namespace hindsight
