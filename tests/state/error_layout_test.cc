#include "state/error_layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace hindsight {
namespace {

Block MakeBlock(BlockKind kind, const char* name, int sensor = 0) {
  Block block;
  block.key = {kind, sensor};
  block.name = name;
  return block;
}

ErrorLayout MixedLayout() {
  ErrorLayout layout = NavigationLayout({});
  layout.Add(MakeBlock(BlockKind::kScale, "odometer_scale", 2));
  Block mounting = MakeBlock(BlockKind::kMounting, "odometer_mounting", 2);
  mounting.active = {false, true, true};
  layout.Add(mounting);
  layout.Add(MakeBlock(BlockKind::kCurrent, "current", 3));
  return layout;
}

TEST(BlockKinds, OfTheNavigationStateEndWithTheBiases) {
  EXPECT_TRUE(IsNavigation(BlockKind::kPosition));
  EXPECT_TRUE(IsNavigation(BlockKind::kAccelBias));
  EXPECT_FALSE(IsNavigation(BlockKind::kGyroScale));
  EXPECT_FALSE(IsNavigation(BlockKind::kSensorError));
}

TEST(ErrorLayout, OffsetsFollowTheOrderOfAdding) {
  const ErrorLayout layout = MixedLayout();
  EXPECT_TRUE(layout.has_canonical_head());
  EXPECT_EQ(layout.dim(), 15 + 1 + 2 + 3);
  EXPECT_EQ(layout.parameter_count(), 1 + 3 + 3);
  const Block* mounting = layout.Find(BlockKind::kMounting, 2);
  ASSERT_NE(mounting, nullptr);
  EXPECT_EQ(mounting->offset, 16);
  EXPECT_EQ(mounting->dim, 2);
  EXPECT_EQ(mounting->parameter_offset, 1);
  const Block* current = layout.Find(BlockKind::kCurrent, 3);
  ASSERT_NE(current, nullptr);
  EXPECT_EQ(current->offset, 18);
  EXPECT_EQ(current->parameter_offset, 4);
  EXPECT_EQ(layout.Find(BlockKind::kAttitude)->offset, 6);
  EXPECT_EQ(layout.Find(BlockKind::kScale), nullptr);
  EXPECT_FALSE(layout.Has(BlockKind::kScale, 1));
  EXPECT_TRUE(layout.Has(BlockKind::kScale, 2));
}

TEST(ErrorLayout, ComponentsAreNamedByAxis) {
  const ErrorLayout layout = MixedLayout();
  EXPECT_EQ(layout.ComponentName(0), "position[north]");
  EXPECT_EQ(layout.ComponentName(8), "attitude[down]");
  EXPECT_EQ(layout.ComponentName(13), "accel_bias[y]");
  EXPECT_EQ(layout.ComponentName(15), "odometer_scale");
  EXPECT_EQ(layout.ComponentName(16), "odometer_mounting[y]");
  EXPECT_EQ(layout.ComponentName(17), "odometer_mounting[z]");
  EXPECT_EQ(layout.ComponentName(19), "current[east]");
  EXPECT_THROW(layout.ComponentName(21), std::out_of_range);
}

TEST(ErrorLayout, HeadIsCanonicalOnlyWhenCompleteAndInOrder) {
  ErrorLayout attitude_only;
  attitude_only.Add(MakeBlock(BlockKind::kAttitude, "attitude", -1));
  attitude_only.Add(MakeBlock(BlockKind::kGyroBias, "gyro_bias", -1));
  EXPECT_FALSE(attitude_only.has_canonical_head());
  const ErrorLayout navigation = NavigationLayout({});
  ErrorLayout masked;
  for (const Block& block : navigation.blocks()) {
    Block copy = block;
    if (copy.key.kind == BlockKind::kVelocity) copy.active[2] = false;
    masked.Add(copy);
  }
  EXPECT_FALSE(masked.has_canonical_head());
  EXPECT_EQ(masked.Find(BlockKind::kAttitude)->offset, 5);
}

TEST(ErrorLayout, RefusesTheSameBlockTwiceButNotForAnotherSensor) {
  ErrorLayout layout = MixedLayout();
  EXPECT_THROW(layout.Add(MakeBlock(BlockKind::kScale, "again", 2)),
               std::logic_error);
  EXPECT_NO_THROW(layout.Add(MakeBlock(BlockKind::kScale, "other", 5)));
}

TEST(ErrorLayout, ExceededCapacityIsRefusedByName) {
  ErrorLayout layout = NavigationLayout({});
  for (int sensor = 0; sensor < kMaxParameters / 3; ++sensor) {
    layout.Add(MakeBlock(BlockKind::kLeverArm, "lever_arm", sensor));
  }
  EXPECT_EQ(layout.dim(), kMaxErrorDim);
  EXPECT_EQ(layout.parameter_count(), kMaxParameters);
  try {
    layout.Add(MakeBlock(BlockKind::kScale, "one_too_many", 0));
    FAIL() << "accepted";
  } catch (const std::logic_error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("one_too_many"));
  }
  // A refused block leaves the layout as it was.
  EXPECT_EQ(layout.dim(), kMaxErrorDim);
  EXPECT_EQ(layout.parameter_count(), kMaxParameters);
  EXPECT_FALSE(layout.Has(BlockKind::kScale, 0));
}

TEST(ErrorLayout, AddColumnsSkipsMaskedAxesAndAbsentBlocks) {
  const ErrorLayout layout = MixedLayout();
  RowJacobian H = RowJacobian::Ones(2, layout.dim());
  Eigen::Matrix<double, 2, 3> J;
  J << 1, 2, 3, 4, 5, 6;
  layout.AddColumns(BlockKind::kMounting, 2, J, &H);
  layout.AddColumns(BlockKind::kMounting, 7, J, &H);
  RowJacobian expected = RowJacobian::Ones(2, layout.dim());
  expected.col(16) += J.col(1);
  expected.col(17) += J.col(2);
  EXPECT_EQ(H, expected);
}

TEST(ErrorLayout, InitialCovarianceSquaresTheActiveSigmas) {
  NavigationPrior prior;
  prior.position_sigma = {1.0, 2.0, 3.0};
  prior.accel_bias_sigma = {0.1, 0.2, 0.3};
  ErrorLayout layout = NavigationLayout(prior);
  Block mounting = MakeBlock(BlockKind::kMounting, "mounting");
  mounting.sigma0 = {5.0, 6.0, 7.0};
  mounting.active = {true, false, true};
  layout.Add(mounting);
  Eigen::VectorXd sigma = Eigen::VectorXd::Zero(17);
  sigma << 1, 2, 3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.1, 0.2, 0.3, 5, 7;
  const Eigen::MatrixXd expected = sigma.cwiseAbs2().asDiagonal();
  EXPECT_EQ(Eigen::MatrixXd(layout.InitialCovariance()), expected);
}

TEST(Evolution, ConstantAndRandomWalk) {
  EXPECT_EQ(Evolution::Constant().Phi(100.0), 1.0);
  EXPECT_EQ(Evolution::Constant().Q(100.0), 0.0);
  EXPECT_EQ(Evolution::RandomWalk(0.5).Phi(100.0), 1.0);
  EXPECT_DOUBLE_EQ(Evolution::RandomWalk(0.5).Q(100.0), 25.0);
  // A walk that does not walk is a constant: one global block in the batch.
  EXPECT_TRUE(Evolution::RandomWalk(0.0).is_constant());
  EXPECT_FALSE(Evolution::RandomWalk(0.1).is_constant());
  EXPECT_EQ(Evolution::RandomWalk(0.1).StationaryVariance(), 0.0);
  EXPECT_EQ(Evolution::RandomWalk(0.5).ChangeVariance(8.0), 2.0);
}

TEST(Evolution, GaussMarkovIsStationary) {
  const Evolution e = Evolution::GaussMarkov(0.3, 50.0);
  EXPECT_DOUBLE_EQ(e.Phi(50.0), std::exp(-1.0));
  for (const double dt : {1e-6, 0.01, 1.0, 50.0, 5000.0}) {
    EXPECT_NEAR(e.Phi(dt) * e.Phi(dt) * 0.09 + e.Q(dt), 0.09, 1e-16) << dt;
  }
  // Short intervals see the driving density alone.
  EXPECT_NEAR(e.Q(1e-6) / (e.density * e.density * 1e-6), 1.0, 1e-7);
  EXPECT_NEAR(e.StationaryVariance(), 0.09, 1e-16);
  EXPECT_NEAR(e.ChangeVariance(50.0), 0.18 * (1.0 - std::exp(-1.0)), 1e-16);
  EXPECT_NEAR(e.ChangeVariance(1e-9) / (0.18 * 1e-9 / 50.0), 1.0, 1e-8);
  // Two steps are one.
  EXPECT_NEAR(e.Phi(2.0) * e.Phi(2.0) * e.Q(3.0) + e.Q(2.0), e.Q(5.0), 1e-16);
}

TEST(Evolution, LongGaussMarkovApproachesAWalk) {
  const Evolution walk = Evolution::RandomWalk(1e-3);
  const Evolution slow = Evolution::GaussMarkov(1e-3 * std::sqrt(0.5e9), 1e9);
  EXPECT_NEAR(slow.Q(10.0) / walk.Q(10.0), 1.0, 2e-8);
}

}  // namespace
}  // namespace hindsight
