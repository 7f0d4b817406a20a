#include "dataset/truth_lever_arm.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/units.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

/// An IMU that stands and is turned to and fro about its z axis, with a truth
/// once a second that speaks of a point at `l_b`, its velocities known to
/// `sigma` [m/s].
Dataset TurnedToAndFro(const Eigen::Vector3d& l_b, double sigma) {
  constexpr double kFastest = 0.1;  // rad/s
  constexpr double kPulse = 0.3;    // rad/s
  const Geodetic place = {0.6, 0.2, -15.0};
  const Eigen::Vector3d p_e = EcefFromGeodetic(place);
  const Eigen::Matrix3d C_ne = NedAxes(p_e).transpose();
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, sigma);
  const auto rate = [](double t) { return kFastest * std::sin(kPulse * t); };
  const auto C_nb = [](double t) {
    return QuaternionFromEuler(
        0.0, 0.0, kFastest / kPulse * (1.0 - std::cos(kPulse * t)));
  };
  Dataset dataset;
  for (int k = 0; k <= 20000; ++k) {
    const double t = 0.01 * k;
    const Eigen::Quaterniond q_bn = C_nb(t).conjugate();
    dataset.imu.samples.push_back(
        {t, q_bn * (C_ne * EarthRate_e()) + Eigen::Vector3d(0, 0, rate(t)),
         q_bn * (C_ne * -Gravity(p_e))});
  }
  for (double t = 0.5; t < 200.0; t += 1.0) {
    TruthPoint point;
    point.t = t;
    point.q_nb = C_nb(t);
    point.p_e = p_e + C_ne.transpose() * (C_nb(t) * l_b);
    point.v_n = C_nb(t) * Eigen::Vector3d(0, 0, rate(t)).cross(l_b) +
                Eigen::Vector3d(noise(random), noise(random), noise(random));
    dataset.truth.push_back(point);
  }
  return dataset;
}

TEST(TruthLeverArm, IsFoundWithItsSigmaWhereTurnsShowIt) {
  const Eigen::Vector3d l_b(1.75, -0.4, 0.0);
  const auto found = FindTruthLeverArm(TurnedToAndFro(l_b, 0.01));
  ASSERT_TRUE(found);
  // Of 199 differences of two velocities, against those of the rate.
  const double expected =
      0.01 * std::sqrt(2.0) / (0.1 * 0.3 * std::sqrt(0.5) * std::sqrt(199.0));
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(found->sigma(i) / expected, 1.0, 0.2);
    EXPECT_LT(std::abs(found->l_b(i) - l_b(i)), 4.0 * found->sigma(i) + 5e-3)
        << found->l_b.transpose() << " +- " << found->sigma.transpose();
  }
}

TEST(TruthLeverArm, IsAsUncertainAsBeforeAlongTheAxisOfAllTurns) {
  const auto found = FindTruthLeverArm(TurnedToAndFro({1.0, 0.0, 2.0}, 0.01));
  ASSERT_TRUE(found);
  EXPECT_GT(found->sigma.z(), 2.0);
  EXPECT_LT(std::abs(found->l_b.z()), 0.5);
}

TEST(TruthLeverArm, NeedsTwentyPairs) {
  Dataset dataset = TurnedToAndFro({1.0, 0.0, 0.0}, 0.01);
  Dataset few = dataset;
  few.truth = {};
  for (std::size_t k = 0; k < 20; ++k) {
    few.truth.push_back(dataset.truth[k]);
  }
  EXPECT_FALSE(FindTruthLeverArm(few));
}

}  // namespace
}  // namespace hindsight
