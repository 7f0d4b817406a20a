#include "receiver_errors/normal_points.h"

#include <gtest/gtest.h>

#include <cmath>

#include "filters/rts.h"
#include "receiver_errors/receiver_tape.h"
#include "receiver_errors/sequence_smoother.h"

namespace hindsight {
namespace {

using testing::AddError;
using testing::Good;
using testing::NominalParameters;
using testing::PositionsOnly;
using testing::TapeOf;
using testing::TestProblem;
using testing::WithoutOutliers;

TEST(NormalPoints, AreNotFormedOfFixesASecondApart) {
  EXPECT_FALSE(FormNormalPoints(TapeOf(PositionsOnly(20.0)), 0).has_value());
}

TEST(NormalPoints, AreCloserInAShortRecording) {
  EXPECT_DOUBLE_EQ(NormalPointInterval(TapeOf(PositionsOnly(20.0))), 0.5);
  EXPECT_DOUBLE_EQ(NormalPointInterval(TapeOf(PositionsOnly(900.0))), 0.75);
  EXPECT_DOUBLE_EQ(NormalPointInterval(TapeOf(PositionsOnly(1300.0))),
                   kNormalPointInterval);
}

TEST(NormalPoints, TellTheTrajectoryAsAllFixesDo) {
  const LinearTape tape = TapeOf(PositionsOnly(40.0, 0.1));
  const auto points = FormNormalPoints(tape, 0);
  ASSERT_TRUE(points.has_value());
  EXPECT_EQ(points->tape.size(), 41u);
  EXPECT_EQ(points->point_of_fix.size(), 401u);
  const SmoothedTrajectory all = SmoothRts(tape);
  const ErrorTrajectory few =
      SmoothSequence({points->tape, 0}, WithoutOutliers(), Good(points->tape));
  for (std::size_t i = 0; i < 40; ++i) {
    const std::size_t k = 10 * i + 5;
    ASSERT_EQ(points->tape.epoch(i).t, tape.epoch(k).t);
    const Eigen::Matrix3d P = all.P.Get(k).topLeftCorner<3, 3>();
    const Eigen::Vector3d d = few[i].head<3>() - all.d[k].head<3>();
    // What is lost is a small part of what is known.
    EXPECT_LT(d.dot(P.llt().solve(d)), 0.2) << i;
  }
}

TEST(NormalPoints, LeaveOutAnOutlierOfTheirInterval) {
  TestProblem problem = PositionsOnly(10.0, 0.1);
  const auto clean = FormNormalPoints(TapeOf(problem), 0);
  AddError(33, 34, {40.0, 0.0, 0.0}, &problem);
  const auto spoilt = FormNormalPoints(TapeOf(problem), 0);
  ASSERT_TRUE(clean && spoilt);
  const Eigen::VectorXd difference = spoilt->tape.measurements(3)[0].residual -
                                     clean->tape.measurements(3)[0].residual;
  EXPECT_LT(difference.norm(), 0.5);
  EXPECT_GT(spoilt->tape.measurements(3)[0].R(0, 0),
            clean->tape.measurements(3)[0].R(0, 0));
}

/// Velocities whose errors are drawn anew at every node: nothing of them is carried
/// from node to node.
TEST(NormalPoints, AreTheSameBesideErrorsThatAreDrawnAnew) {
  TestProblem problem = PositionsOnly(10.0, 0.1);
  const auto alone = FormNormalPoints(TapeOf(problem), 0);
  Measurement velocity = problem.measurements[0];
  velocity.sensor = 1;
  std::vector<Measurement> all;
  for (std::size_t k = 0; k < problem.nodes.size(); ++k) {
    const State& x = problem.truth[k];
    velocity.t = x.t;
    velocity.model = VelocityFix{.v_n = x.C_en().transpose() * x.v_e};
    problem.nodes[k].first_measurement = static_cast<int>(all.size());
    problem.nodes[k].measurement_count = 2;
    all.insert(all.end(), {problem.measurements[k], velocity});
  }
  problem.measurements = all;
  Block error;
  error.key = {BlockKind::kColouredNoise, 1};
  error.sigma0 = Eigen::Vector3d::Ones();
  error.evolution = Evolution::GaussMarkov(1.0, 1e-6);
  ASSERT_EQ(error.evolution.Phi(0.1), 0.0);
  problem.layout.Add(error);
  for (State& x : problem.truth)
    x.parameters = NominalParameters(problem.layout);
  problem.prior.x.parameters.conservativeResize(
      problem.layout.parameter_count());
  problem.prior.x.parameters.tail<3>().setZero();
  const Eigen::Index dim = problem.prior.P.rows();
  ErrorMatrix P = ErrorMatrix::Identity(dim + 3, dim + 3);
  P.topLeftCorner(dim, dim) = problem.prior.P;
  problem.prior.P = P;
  const auto beside = FormNormalPoints(TapeOf(problem), 0);
  ASSERT_TRUE(alone && beside);
  ASSERT_EQ(beside->tape.size(), alone->tape.size());
  for (std::size_t i = 0; i < alone->tape.size(); ++i) {
    const TapeMeasurement own = alone->tape.measurements(i)[0];
    ASSERT_EQ(beside->tape.measurements(i).size(), 2u) << i;
    const TapeMeasurement same = beside->tape.measurements(i)[0];
    EXPECT_LT((same.residual - own.residual).norm(), 1e-9) << i;
    EXPECT_LT((same.H.leftCols(dim) - own.H).norm(), 1e-9) << i;
    EXPECT_LT((same.R - own.R).norm(), 1e-9) << i;
    EXPECT_TRUE(beside->tape.measurements(i)[1].R.allFinite()) << i;
  }
}

/// Positions ten times a second, of which the first of each second is that of the
/// sensor in question, but for the third ten seconds, and the rest another's.
TEST(ThinBetweenFixes, KeepsTheFixesAndTellsTheTrajectory) {
  TestProblem problem = PositionsOnly(40.0, 0.1);
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const bool own = k % 10 == 0 && (k < 200 || k >= 300);
    problem.measurements[k].sensor = own ? 0 : 1;
  }
  const LinearTape tape = TapeOf(problem);
  const auto thinned = ThinBetweenFixes(tape, 0);
  ASSERT_TRUE(thinned.has_value());
  const SmoothedTrajectory all = SmoothRts(tape);
  const ErrorTrajectory few =
      SmoothSequence({*thinned, 0}, WithoutOutliers(), Good(*thinned));
  std::size_t fixes = 0;
  for (std::size_t i = 0; i < thinned->size(); ++i) {
    const auto k = static_cast<std::size_t>(std::lround(thinned->t(i) / 0.1));
    ASSERT_EQ(thinned->t(i), tape.t(k));
    if (i > 0) {
      EXPECT_LE(thinned->t(i) - thinned->t(i - 1), 1.51);
    }
    const Eigen::Matrix3d P = all.P.Get(k).topLeftCorner<3, 3>();
    const Eigen::Vector3d d = few[i].head<3>() - all.d[k].head<3>();
    EXPECT_LT(d.dot(P.llt().solve(d)), 0.2) << i;
    if (!HasFix(*thinned, i, 0)) continue;
    ++fixes;
    const TapeMeasurement own = tape.measurements(k)[0];
    const TapeMeasurement same = thinned->measurements(i)[0];
    EXPECT_LT((same.residual - own.residual).norm(), 1e-9);
    EXPECT_LT((same.H - own.H).norm(), 1e-9);
    EXPECT_LT((same.R - own.R).norm(), 1e-9);
  }
  EXPECT_EQ(fixes, 31u);
  EXPECT_FALSE(ThinBetweenFixes(TapeOf(PositionsOnly(20.0)), 0).has_value());
}

/// As wheels at the rate of the fixes do: half of the nodes are theirs.
TEST(ThinBetweenFixes, CarriesWhatComesAsOftenAsTheFixes) {
  TestProblem problem = PositionsOnly(40.0, 0.5);
  std::size_t fixes = 0;
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    problem.measurements[k].sensor = static_cast<int>(k % 2);
    fixes += k % 2 == 0 ? 1 : 0;
  }
  const auto thinned = ThinBetweenFixes(TapeOf(problem), 0);
  ASSERT_TRUE(thinned.has_value());
  EXPECT_EQ(thinned->size(), fixes);
}

TEST(NormalPoints, GiveTheirStepsToTheirFirstFixes) {
  const auto points = FormNormalPoints(TapeOf(PositionsOnly(6.0, 0.25)), 0);
  ASSERT_TRUE(points.has_value());
  ModeSequence sequence = Good(points->tape);
  sequence[2] = {ErrorMode::kBiased, true};
  sequence[3] = {ErrorMode::kBiased};
  const ModeSequence at_fixes = AtFixes(*points, sequence);
  ASSERT_EQ(at_fixes.size(), points->point_of_fix.size());
  EXPECT_EQ(at_fixes[7], ErrorStep{ErrorMode::kGood});
  EXPECT_EQ(at_fixes[8], (ErrorStep{ErrorMode::kBiased, true}));
  EXPECT_EQ(at_fixes[9], ErrorStep{ErrorMode::kBiased});
  EXPECT_EQ(at_fixes[15], ErrorStep{ErrorMode::kBiased});
  EXPECT_EQ(at_fixes[16], ErrorStep{ErrorMode::kGood});
}

}  // namespace
}  // namespace hindsight
