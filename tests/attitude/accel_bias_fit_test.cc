#include "attitude/accel_bias_fit.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/random.h"
#include "base/units.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

struct Swaying {
  ImuStream imu;
  std::vector<Eigen::Quaterniond> q_nb;
};

/// Two minutes at 50 Hz with accelerations of 0.3 m/s^2 an axis and a bias, of a
/// body that turns by up to `swing` [rad].
Swaying SwayingWith(const Eigen::Vector3d& bias, double swing) {
  Random random(4);
  Swaying body;
  for (int k = 0; k < 6000; ++k) {
    const double t = 0.02 * k;
    const Eigen::Quaterniond q = QuaternionFromEuler(
        swing * std::sin(0.31 * t), swing * std::sin(0.47 * t + 1.0), 0.2 * t);
    ImuSample sample;
    sample.t = t;
    sample.accel =
        q.conjugate() * Eigen::Vector3d(0.0, 0.0, -kStandardGravity) + bias +
        0.3 * random.NormalVector3();
    body.imu.samples.push_back(sample);
    body.q_nb.push_back(q);
  }
  return body;
}

TEST(AccelBiasFit, FindsABiasInManyAttitudes) {
  const Eigen::Vector3d bias(0.8, -0.3, 0.5);
  const Swaying body = SwayingWith(bias, 1.2);
  const AccelBiasFit fit = FitAccelBias(body.imu, body.q_nb, kStandardGravity,
                                        Eigen::Vector3d::Zero());
  // 120 means, each with 0.3 / sqrt(50) m/s^2, in a few attitudes.
  EXPECT_LT((fit.b_a - bias).norm(), 0.05);
  EXPECT_GT(fit.significance, 100.0);
  EXPECT_LT(
      FitAccelBias(body.imu, body.q_nb, kStandardGravity, bias).significance,
      16.3)
      << "beside what is known";
}

TEST(AccelBiasFit, InventsNone) {
  const Swaying body = SwayingWith(Eigen::Vector3d::Zero(), 1.2);
  EXPECT_LT(FitAccelBias(body.imu, body.q_nb, kStandardGravity,
                         Eigen::Vector3d::Zero())
                .significance,
            16.3);  // chi-square, 3 degrees, 99.9 %
}

/// A level body shows the size of gravity alone, which c takes.
TEST(AccelBiasFit, KnowsNothingOfABodyThatHardlyTurns) {
  const Swaying body = SwayingWith({0.8, -0.3, 0.5}, 0.01);
  EXPECT_LT(FitAccelBias(body.imu, body.q_nb, kStandardGravity,
                         Eigen::Vector3d::Zero())
                .significance,
            16.3);
}

/// A body that sways little tells much of what tilts it, and nothing of the
/// vertical, however long: that is left out.
TEST(AccelBiasFit, LeavesOutWhatIsNotKnown) {
  const Eigen::Vector3d bias(2.0, -1.0, 0.0);
  const Swaying body = SwayingWith(bias, 0.15);
  const AccelBiasFit fit = FitAccelBias(body.imu, body.q_nb, kStandardGravity,
                                        Eigen::Vector3d::Zero());
  EXPECT_GT(fit.significance, 21.1);
  EXPECT_LT(std::abs(fit.b_a.z()), 0.2);
  EXPECT_LT((fit.b_a - bias).head<2>().norm(), 0.3);
}

}  // namespace
}  // namespace hindsight
