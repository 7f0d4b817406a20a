#include "receiver_errors/normal_points.h"

#include <gtest/gtest.h>

#include "filters/rts.h"
#include "receiver_errors/receiver_tape.h"
#include "receiver_errors/sequence_smoother.h"

namespace hindsight {
namespace {

using testing::AddError;
using testing::Good;
using testing::PositionsOnly;
using testing::TapeOf;
using testing::TestProblem;
using testing::WithoutOutliers;

TEST(NormalPoints, AreNotFormedOfFixesASecondApart) {
  EXPECT_FALSE(FormNormalPoints(TapeOf(PositionsOnly(20.0)), 0).has_value());
}

TEST(NormalPoints, TellTheTrajectoryAsAllFixesDo) {
  const LinearTape tape = TapeOf(PositionsOnly(40.0, 0.1));
  const auto points = FormNormalPoints(tape, 0);
  ASSERT_TRUE(points.has_value());
  EXPECT_EQ(points->tape.size(), 41u);
  EXPECT_EQ(points->point_of_fix.size(), 401u);
  const SmoothedTrajectory all = SmoothRts(tape);
  const std::vector<ErrorVector> few =
      SmoothSequence(points->tape, 0, WithoutOutliers(), Good(points->tape));
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
