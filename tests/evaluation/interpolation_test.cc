#include "evaluation/interpolation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace hindsight {
namespace {

constexpr double kRadius = 50.0;  // [m]
constexpr double kRate = 0.2;     // [rad/s]
constexpr Geodetic kCentre{0.8, 0.2, 100.0};

/// A circle in the tangent plane at a fixed point, forward along the path.
struct Circle {
  Eigen::Vector3d origin = EcefFromGeodetic(kCentre);
  Eigen::Matrix3d C_en = NedAxes(origin);

  Eigen::Vector3d p_e(double t) const {
    return origin +
           C_en * (kRadius * Eigen::Vector3d(std::cos(kRate * t),
                                             std::sin(kRate * t), 0.0));
  }
  Eigen::Vector3d v_e(double t) const {
    return C_en *
           (kRadius * kRate *
            Eigen::Vector3d(-std::sin(kRate * t), std::cos(kRate * t), 0.0));
  }
  Eigen::Quaterniond q_eb(double t) const {
    return Eigen::Quaterniond(C_en) *
           QuaternionFromEuler(0.1, 0.05, 0.5 * kPi + kRate * t);
  }
};

SolutionTable CircleTable(double spacing, int rows) {
  const Circle circle;
  SolutionTable table;
  for (int k = 0; k < rows; ++k) {
    const double t = k * spacing;
    table.t.push_back(t);
    table.p_e.push_back(circle.p_e(t));
    table.v_e.push_back(circle.v_e(t));
    table.q_eb.push_back(circle.q_eb(t));
  }
  return table;
}

TEST(Interpolation, OfACircleStaysWithinTheRemainderOfTheCubic) {
  const Circle circle;
  constexpr double h = 0.5;
  const SolutionTable table = CircleTable(h, 41);
  const TrajectoryInterpolator interpolator(table, 1.0);
  const double fourth = kRadius * std::pow(kRate, 4);  // |p''''| = |v'''|
  const double p_bound = std::pow(h, 4) / 384.0 * fourth + 1e-8;
  // Slopes from three rows are off by h^2/6 times the third derivative, nearly
  // the same at both ends, of which the cubic passes on h u (1 - u)(1 - 2 u);
  // what they differ by and the remainder of the cubic are below h^4/24 times
  // the fourth.
  const double v_bound = std::pow(h, 3) / (36.0 * std::sqrt(3.0)) * fourth +
                         std::pow(h, 4) / 24.0 * fourth * kRate;
  double p_worst = 0.0;
  double v_worst = 0.0;
  for (double t = h; t <= 19.5; t += 0.037) {
    const auto x = interpolator.At(t);
    ASSERT_TRUE(x);
    p_worst = std::max(p_worst, (*x->p_e - circle.p_e(t)).norm());
    v_worst = std::max(v_worst, (*x->v_e - circle.v_e(t)).norm());
    EXPECT_LT(x->q_eb->angularDistance(circle.q_eb(t)), 1e-7);
  }
  EXPECT_LT(p_worst, p_bound);
  EXPECT_LT(v_worst, v_bound);
  // The bounds are tight, so that a wrong slope would break them.
  EXPECT_GT(p_worst, 0.5 * p_bound);
  EXPECT_GT(v_worst, 0.5 * v_bound);
}

TEST(Interpolation, ReturnsTheRowsThemselves) {
  const SolutionTable table = CircleTable(0.5, 9);
  const TrajectoryInterpolator interpolator(table, 1.0);
  for (std::size_t k = 0; k < table.size(); ++k) {
    const auto x = interpolator.At(table.t[k]);
    ASSERT_TRUE(x);
    EXPECT_EQ((*x->p_e - table.p_e[k]).norm(), 0.0);
    EXPECT_LT((*x->v_e - table.v_e[k]).norm(), 1e-14);
    EXPECT_LT(x->q_eb->angularDistance(table.q_eb[k]), 1e-7);
  }
}

TEST(Interpolation, GivesTheBodyRate) {
  const SolutionTable table = CircleTable(0.5, 9);
  const auto x = TrajectoryInterpolator(table, 1.0).At(1.3);
  ASSERT_TRUE(x);
  const Eigen::Vector3d w_n(0.0, 0.0, kRate);
  const Eigen::Vector3d expected =
      QuaternionFromEuler(0.1, 0.05, 0.0).conjugate() * w_n;
  EXPECT_LT((x->w_eb_b - expected).norm(), 1e-10);
}

TEST(Interpolation, IsExactForConstantAccelerationsUpToTheEnds) {
  SolutionTable table;
  const auto angle = [](double t) { return 0.03 * t + 0.04 * t * t; };
  for (const double t : {0.0, 1.0, 1.5, 2.5, 4.0}) {
    table.t.push_back(t);
    table.p_e.emplace_back(6378137.0, 2.0 * t, 3.0 - 0.5 * t * t);
    table.q_eb.push_back(QuaternionFromEuler(0.0, 0.0, angle(t)));
  }
  const TrajectoryInterpolator interpolator(table, 2.0);
  for (const double t : {0.4, 1.2, 2.0, 3.3}) {
    const auto x = interpolator.At(t);
    ASSERT_TRUE(x);
    EXPECT_LT((*x->p_e - Eigen::Vector3d(6378137.0, 2.0 * t, 3.0 - 0.5 * t * t))
                  .norm(),
              1e-12);
    EXPECT_NEAR(EulerFromQuaternion(*x->q_eb).z(), angle(t), 1e-12);
    EXPECT_FALSE(x->v_e);
  }
}

TEST(Interpolation, NeitherBridgesGapsNorExtrapolates) {
  SolutionTable table;
  for (const double t : {0.0, 1.0, 5.0, 6.0}) {
    table.t.push_back(t);
    table.q_eb.push_back(Eigen::Quaterniond::Identity());
  }
  const TrajectoryInterpolator interpolator(table, 2.0);
  EXPECT_TRUE(interpolator.At(0.0));
  EXPECT_TRUE(interpolator.At(0.7));
  EXPECT_TRUE(interpolator.At(1.0));
  EXPECT_FALSE(interpolator.At(1.001));
  EXPECT_FALSE(interpolator.At(3.0));
  EXPECT_TRUE(interpolator.At(5.0));
  EXPECT_TRUE(interpolator.At(6.0));
  EXPECT_FALSE(interpolator.At(6.001));
  EXPECT_FALSE(interpolator.At(-0.001));
}

TEST(Interpolation, DoesNotTakeAJumpForMotion) {
  // A filter's update between two rows a millisecond apart.
  SolutionTable table;
  const double v[] = {10.0, 10.0, 10.05, 10.05};
  const double t[] = {0.0, 1.0, 1.001, 2.0};
  for (int k = 0; k < 4; ++k) {
    table.t.push_back(t[k]);
    table.v_e.emplace_back(v[k], 0.0, 0.0);
  }
  const TrajectoryInterpolator interpolator(table, 2.0);
  EXPECT_NEAR(interpolator.At(0.5)->v_e->x(), 10.0, 1e-12);
  EXPECT_NEAR(interpolator.At(1.5)->v_e->x(), 10.05, 1e-12);
}

TEST(Interpolation, OfASingleRowIsThatRow) {
  SolutionTable table;
  table.t = {3.0};
  table.p_e = {{1.0, 2.0, 3.0}};
  const TrajectoryInterpolator interpolator(table, 2.0);
  ASSERT_TRUE(interpolator.At(3.0));
  EXPECT_EQ(*interpolator.At(3.0)->p_e, table.p_e[0]);
  EXPECT_FALSE(interpolator.At(3.0)->v_e);
  EXPECT_FALSE(interpolator.At(3.001));
}

TEST(Interpolation, BlendsCovariancesLinearly) {
  SolutionTable table;
  table.t = {0.0, 2.0};
  table.P_position = {Eigen::Matrix3d::Identity(),
                      5.0 * Eigen::Matrix3d::Identity()};
  const auto x = TrajectoryInterpolator(table, 2.0).At(0.5);
  ASSERT_TRUE(x);
  EXPECT_TRUE(x->P_position->isApprox(2.0 * Eigen::Matrix3d::Identity()));
  EXPECT_FALSE(x->P_velocity);
}

}  // namespace
}  // namespace hindsight
