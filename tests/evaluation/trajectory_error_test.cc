#include "evaluation/trajectory_error.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "base/chi_square.h"
#include "base/random.h"
#include "base/units.h"

namespace hindsight {
namespace {

const Geodetic kPlace{45.0 * kDegree, 179.99999 * kDegree, 120.0};

/// Two rows, 1 s apart, at rest with the given attitude.
SolutionTable AtRest(const Eigen::Vector3d& euler) {
  SolutionTable table;
  for (const double t : {10.0, 11.0}) {
    const State x = MakeState(t, kPlace, Eigen::Vector3d::Zero(), euler);
    table.t.push_back(t);
    table.p_e.push_back(x.p_e);
    table.v_e.push_back(x.v_e);
    table.q_eb.push_back(x.q_eb);
  }
  return table;
}

TruthPoint TruthPosition(double t, const Eigen::Vector3d& p_e) {
  TruthPoint truth;
  truth.t = t;
  truth.p_e = p_e;
  return truth;
}

TruthPoint TruthAttitude(double t, const Eigen::Vector3d& euler) {
  TruthPoint truth;
  truth.t = t;
  truth.q_nb = QuaternionFromEuler(euler.x(), euler.y(), euler.z());
  return truth;
}

Eigen::Vector3d Displaced(const Eigen::Vector3d& dr_n) {
  const Eigen::Vector3d p_e = EcefFromGeodetic(kPlace);
  return p_e + NedAxes(p_e) * dr_n;
}

TEST(TrajectoryError, OfAPositionOnlyTruthMatchesHandComputedCase) {
  SolutionTable table = AtRest({0.0, 0.0, 0.0});
  table.P_position.assign(2, Eigen::Vector3d(9.0, 16.0, 4.0).asDiagonal());
  const TruthPoint truth = TruthPosition(10.5, Displaced({3.0, 4.0, -2.0}));
  const TrajectoryStatistics s =
      EvaluateTrajectory(table, TruthSeries({truth}), {});
  ASSERT_TRUE(s.position);
  EXPECT_NEAR(s.position->axis[0].mean, 3.0, 1e-8);
  EXPECT_NEAR(s.position->axis[1].mean, 4.0, 1e-8);
  EXPECT_NEAR(s.position->axis[2].mean, -2.0, 1e-8);
  EXPECT_NEAR(s.position->horizontal.rms, 5.0, 1e-8);
  EXPECT_NEAR(s.position->total.max, std::sqrt(29.0), 1e-8);
  EXPECT_NEAR(*s.position_nees, 3.0, 1e-8);
  EXPECT_FALSE(s.velocity);
  EXPECT_FALSE(s.attitude);
  EXPECT_FALSE(s.velocity_nees);
  EXPECT_DOUBLE_EQ(s.matched_percent(), 100.0);
}

TEST(TrajectoryError, AppliesTheTruthLeverArm) {
  // Heading east: a point 2 m forward and 1 m right lies 2 m east, 1 m south.
  const SolutionTable table = AtRest({0.0, 0.0, 90.0 * kDegree});
  const TruthPoint truth = TruthPosition(10.0, Displaced({-1.0, 2.0, 0.5}));
  const auto errors = ComputeTrajectoryErrors(
      table, TruthSeries({truth}), {.truth_lever_arm_b = {2.0, 1.0, 0.5}});
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_LT(errors[0].position->norm(), 1e-8);
}

TEST(TrajectoryError, MovesTheVelocityToTheTruthPoint) {
  // Turning on the spot at 0.1 rad/s: 2 m forward moves sideways at 0.2 m/s.
  SolutionTable table;
  for (int k = 0; k < 5; ++k) {
    const State x =
        MakeState(k, kPlace, Eigen::Vector3d::Zero(), {0.0, 0.0, 0.1 * k});
    table.t.push_back(x.t);
    table.p_e.push_back(x.p_e);
    table.v_e.push_back(x.v_e);
    table.q_eb.push_back(x.q_eb);
  }
  const double heading = 0.1 * 2.5;
  TruthPoint truth;
  truth.t = 2.5;
  truth.v_n =
      Eigen::Vector3d(-0.2 * std::sin(heading), 0.2 * std::cos(heading), 0.0);
  const auto errors = ComputeTrajectoryErrors(
      table, TruthSeries({truth}), {.truth_lever_arm_b = {2.0, 0.0, 0.0}});
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_LT(errors[0].velocity->norm(), 1e-9);
  EXPECT_FALSE(errors[0].position);
}

TEST(TrajectoryError, NormalisedErrorsCountTheTruthsOwn) {
  SolutionTable table = AtRest({0.0, 0.0, 0.0});
  const std::size_t n = table.t.size();
  table.P_position.assign(n, 4.0 * Eigen::Matrix3d::Identity());
  table.P_velocity.assign(n, 1e-4 * Eigen::Matrix3d::Identity());
  table.P_attitude.assign(n, 1e-6 * Eigen::Matrix3d::Identity());
  TruthPoint truth = TruthAttitude(10.3, {0.002, 0.0, 0.0});
  truth.p_e = table.p_e[0] + NedAxes(table.p_e[0]) * Eigen::Vector3d(3, 0, 0);
  truth.v_n = Eigen::Vector3d(0.0, 0.02, 0.0);
  const auto nees = [&](const TruthSigma& sigma) {
    return EvaluateTrajectory(table, TruthSeries({truth}),
                              {.truth_sigma = sigma});
  };
  const TrajectoryStatistics exact = nees({});
  EXPECT_NEAR(*exact.position_nees, 9.0 / 4.0, 1e-6);
  EXPECT_NEAR(*exact.velocity_nees, 4.0, 1e-6);
  EXPECT_NEAR(*exact.attitude_nees, 4.0, 1e-6);
  const TrajectoryStatistics stated =
      nees({.position = Eigen::Vector3d(std::sqrt(5.0), 1.0, 1.0),
            .velocity = Eigen::Vector3d(1.0, std::sqrt(3e-4), 1.0),
            .attitude = Eigen::Vector3d(std::sqrt(3e-6), 1.0, 1.0)});
  EXPECT_NEAR(*stated.position_nees, 1.0, 1e-6);
  EXPECT_NEAR(*stated.velocity_nees, 1.0, 1e-6);
  EXPECT_NEAR(*stated.attitude_nees, 1.0, 1e-6);
}

TEST(TrajectoryError, WrapsTheHeadingDifference) {
  const SolutionTable table = AtRest({0.0, 0.0, 179.0 * kDegree});
  const TruthPoint truth = TruthAttitude(10.3, {0.0, 0.0, -179.0 * kDegree});
  const auto errors = ComputeTrajectoryErrors(table, TruthSeries({truth}), {});
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_LT((*errors[0].euler - Eigen::Vector3d(0, 0, 2 * kDegree)).norm(),
            1e-10);
  EXPECT_LT((*errors[0].rotation - Eigen::Vector3d(0, 0, 2 * kDegree)).norm(),
            1e-10);
}

TEST(TrajectoryError, ComparesAttitudesWithoutAPlace) {
  SolutionTable table;
  table.t = {0.0, 1.0};
  table.q_eb.assign(2, QuaternionFromEuler(0.1, 0.2, 0.3));
  const TruthPoint truth = TruthAttitude(0.5, {0.11, 0.2, 0.3});
  const TrajectoryStatistics s =
      EvaluateTrajectory(table, TruthSeries({truth}), {});
  EXPECT_FALSE(s.position);
  ASSERT_TRUE(s.attitude);
  EXPECT_NEAR(s.attitude->axis[0].rms, 0.01, 1e-12);
  EXPECT_NEAR(s.attitude->total.rms, 0.01, 1e-12);
}

TEST(TrajectoryError, CountsTruthThatCannotBeMatched) {
  const SolutionTable table = AtRest({0.0, 0.0, 0.0});
  TruthSeries truth;
  for (int k = 0; k < 8; ++k) {
    truth.push_back(TruthPosition(9.5 + 0.25 * k, table.p_e[0]));
  }
  const TrajectoryStatistics s = EvaluateTrajectory(table, truth, {});
  EXPECT_EQ(s.matched_count, 5u);
  EXPECT_DOUBLE_EQ(s.matched_percent(), 62.5);
  const TrajectoryStatistics none = EvaluateTrajectory(
      table, TruthSeries({TruthPosition(99.0, table.p_e[0])}), {});
  EXPECT_FALSE(none.position);
  EXPECT_DOUBLE_EQ(none.matched_percent(), 0.0);
}

TEST(TrajectoryError, NormalisedErrorsOfAConsistentEstimateAverageThree) {
  Eigen::Matrix3d P;
  P << 4.0, 1.5, -0.5, 1.5, 2.0, 0.3, -0.5, 0.3, 1.0;
  const Eigen::Matrix3d L = P.llt().matrixL();
  constexpr double kAngleScale = 1e-3;
  constexpr int kRuns = 2000;
  const Eigen::Vector3d euler(0.2, -0.4, 1.9);
  SolutionTable table = AtRest(euler);
  table.P_position.assign(2, P);
  table.P_velocity.assign(2, P);
  table.P_attitude.assign(2, kAngleScale * kAngleScale * P);
  Random random(7);
  TruthSeries truth;
  const auto draw = [&]() -> Eigen::Vector3d {
    return L * random.NormalVector3();
  };
  for (int k = 0; k < kRuns; ++k) {
    TruthPoint point = TruthPosition(10.5, Displaced(draw()));
    // The truth's own axes turn by dr/R, 1e-6 of the errors here.
    point.v_n = draw();
    point.q_nb = Exp(kAngleScale * draw()) *
                 QuaternionFromEuler(euler.x(), euler.y(), euler.z());
    truth.push_back(point);
  }
  const TrajectoryStatistics s = EvaluateTrajectory(table, truth, {});
  const Interval bounds = AneesBounds(kRuns, 3, 0.99);
  EXPECT_TRUE(bounds.Contains(*s.position_nees)) << *s.position_nees;
  EXPECT_TRUE(bounds.Contains(*s.velocity_nees)) << *s.velocity_nees;
  EXPECT_TRUE(bounds.Contains(*s.attitude_nees)) << *s.attitude_nees;
  // A part p of kRuns scatters by sqrt(p (1 - p) / kRuns).
  constexpr double kInside = 0.9973;
  EXPECT_NEAR(*s.attitude_inside, kInside,
              3.0 * std::sqrt(kInside * (1.0 - kInside) / kRuns));
}

TEST(TrajectoryError, HasNoNormalisedErrorForASingularCovariance) {
  SolutionTable table = AtRest({0.0, 0.0, 0.0});
  table.P_position.assign(2, Eigen::Vector3d(1.0, 0.0, 1.0).asDiagonal());
  const TrajectoryStatistics s = EvaluateTrajectory(
      table, TruthSeries({TruthPosition(10.0, table.p_e[0])}), {});
  EXPECT_TRUE(s.position);
  EXPECT_FALSE(s.position_nees);
}

}  // namespace
}  // namespace hindsight
