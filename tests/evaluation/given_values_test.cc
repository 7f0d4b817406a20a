#include "evaluation/given_values.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/test_motion.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using testing::TypicalLayout;
using testing::TypicalState;

/// A start of sigma one in every component, and a solution whose first and
/// last states are that far from it in one, with sigmas of `ratio`.
class GivenValues : public ::testing::Test {
 protected:
  GivenValues() {
    start_.x = TypicalState();
    start_.P = TypicalLayout().InitialCovariance();
    start_.position = "position fix at t = 3.00 s";
    start_.alignment = "velocity";
  }

  std::vector<Evidence> Find(int component, double sigmas) {
    Solution solution;
    solution.layout = TypicalLayout();
    const int dim = solution.layout.dim();
    ErrorVector d = ErrorVector::Zero(dim);
    d(component) = sigmas * std::sqrt(start_.P(component, component));
    solution.states = {Retract(solution.layout, TypicalState(), d)};
    std::vector<Evidence> found;
    FindStrainedValues({.solution = solution, .start = start_}, &found);
    return found;
  }

  StartValues start_;
};

TEST_F(GivenValues, ChanceIsNoContradiction) {
  const int count = TypicalLayout().dim();
  for (int i = 0; i < count; ++i) {
    EXPECT_TRUE(Find(i, StrainLimit(count) - 0.1).empty()) << i;
    ASSERT_EQ(Find(i, StrainLimit(count) + 0.1).size(), 1u) << i;
    EXPECT_EQ(Find(i, 7.0)[0].limit, StrainLimit(count)) << i;
  }
}

TEST_F(GivenValues, WhatTheConfigurationGaveIsNamedByItsKey) {
  start_.given.position = Geodetic{};
  for (const double sigmas : {5.1, -30.0}) {
    const auto found = Find(2, sigmas);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].grade, Grade::kDoubtful);
    EXPECT_THAT(found[0].what, StartsWith("position[down] at the start is "));
    EXPECT_THAT(found[0].what, HasSubstr("from its given value"));
    EXPECT_NEAR(*found[0].value, std::abs(sigmas), 0.01);
    EXPECT_EQ(found[0].limit, StrainLimit(3));
    EXPECT_THAT(found[0].causes.at(0), HasSubstr("initial.position"));
  }
}

/// Two-sided normal probabilities: 2.97 sigma of 0.3 %, 3.48 of a sixth of it.
TEST_F(GivenValues, OfManyOneLiesFarOffByChance) {
  EXPECT_NEAR(StrainLimit(1), 2.968, 1e-3);
  EXPECT_NEAR(StrainLimit(6), 3.481, 1e-3);
  start_.given.position = Geodetic{};
  start_.given.euler = Eigen::Vector3d::Zero();
  for (int i : {0, 2, 6, 8}) {
    EXPECT_TRUE(Find(i, 3.4).empty()) << i;
    ASSERT_EQ(Find(i, 3.6).size(), 1u) << i;
    EXPECT_EQ(Find(i, 3.6)[0].limit, StrainLimit(6)) << i;
  }
  // What the program chose is counted by itself.
  const int own = TypicalLayout().dim() - 6;
  EXPECT_TRUE(Find(4, StrainLimit(own) - 0.1).empty());
  EXPECT_EQ(Find(4, StrainLimit(own) + 0.1).at(0).limit, StrainLimit(own));
}

/// Of two sigmas of the prior that are left with 0.9 of it: 4.6 times the 0.44
/// that chance moves it by. Never less than a tenth of the prior.
TEST_F(GivenValues, WhatIsHardlyLearnedIsHeldAgainstWhatChanceWouldMoveItBy) {
  EXPECT_NEAR(StrainOf(2.0, 1.0, 0.81), 2.0 / std::sqrt(0.19), 1e-12);
  EXPECT_NEAR(StrainOf(-2.0, 1.0, 1.0), 20.0, 1e-12);
  EXPECT_EQ(StrainOf(0.99, 1.0, 0.9999), 0.0);
  EXPECT_EQ(StrainOf(4.0, 1.0, 0.0), 4.0);
}

/// As of methods that estimate the IMU's errors beside their states.
TEST_F(GivenValues, ConstantsBesideTheStatesAreHeldAgainstTheirPriorsToo) {
  Solution solution;
  solution.layout = TypicalLayout();
  ConstantEstimate scale;
  scale.name = "gyro_scale[x]";
  scale.prior_sigma = 0.01;
  scale.sigma = 0.001;
  const auto find = [&](double value) {
    scale.value = value;
    solution.constants = {scale};
    std::vector<Evidence> found;
    FindStrainedValues({.solution = solution}, &found);
    return found;
  };
  EXPECT_TRUE(find(0.029).empty());
  ASSERT_EQ(find(-0.031).size(), 1u);
  EXPECT_EQ(find(-0.031)[0].limit, StrainLimit(1));
  EXPECT_THAT(find(-0.031)[0].what, StartsWith("gyro_scale[x] ends 0.031 "));
  EXPECT_THAT(find(-0.031)[0].causes.at(0), HasSubstr("the gyros' unit"));
}

/// The program's own start had too small a sigma, which is nobody's input.
TEST_F(GivenValues, OwnStartIsNamedWithTheKeyToSet) {
  const auto found = Find(8, 7.0);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found[0].what, HasSubstr("from the program's own start "
                                       "(alignment velocity)"));
  EXPECT_THAT(found[0].remedies.at(0), HasSubstr("initial.attitude"));
  start_.given.heading = 0.0;
  EXPECT_THAT(Find(8, 7.0).at(0).what, HasSubstr("from its given value"));
  EXPECT_THAT(Find(7, 7.0).at(0).what, HasSubstr("the program's own start"));
}

/// The start has combined it with what a rest says.
TEST_F(GivenValues, GivenGyroBiasIsHeldAgainstItsOwnSigma) {
  const Eigen::Vector3d sigma(1e-4, 1e-4, 1e-4);
  const int i = TypicalLayout().Find(BlockKind::kGyroBias)->offset;
  start_.given.gyro_bias_sigma = sigma;
  start_.given.gyro_bias =
      TypicalState().b_g - 6.0 * sigma.x() * Eigen::Vector3d::UnitX();
  const auto found = Find(i, 0.0);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found[0].what, HasSubstr("6.0 sigma from its given value"));
  EXPECT_THAT(found[0].causes.at(0), HasSubstr("initial.gyro_bias"));
  // Within its own sigma, but the start had too small a one.
  start_.given.gyro_bias_sigma = 1e3 * sigma;
  EXPECT_THAT(Find(i, 7.0).at(0).what, HasSubstr("the program's own start"));
}

TEST_F(GivenValues, ConstantOfASensorIsNamedByItsKey) {
  Sensor sensor;
  sensor.name = "gnss";
  ErrorLayout layout = TypicalLayout();
  Block block;
  block.key = {BlockKind::kLeverArm, 0};
  block.name = "gnss_lever_arm";
  block.sigma0.setConstant(0.1);
  layout.Add(block);
  start_.x.parameters = ParameterVector::Zero(layout.parameter_count());
  start_.P = layout.InitialCovariance();
  Solution solution;
  solution.layout = layout;
  // A filter's first state knows nothing yet of a constant.
  solution.states = {start_.x, start_.x};
  solution.states[1].t += 10.0;
  std::vector<Evidence> found;
  const auto find = [&](double metres) {
    found.clear();
    solution.states[1].parameters(layout.blocks().back().parameter_offset + 1) =
        metres;
    FindStrainedValues({.solution = solution,
                        .sensors = std::span<const Sensor>(&sensor, 1),
                        .start = start_},
                       &found);
  };
  find(0.32);
  EXPECT_TRUE(found.empty());
  find(0.34);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].what,
            "gnss_lever_arm[y] is 3.4 sigma from its given value");
  EXPECT_EQ(found[0].remedies.at(0), "another aiding.gnss.lever_arm");
  EXPECT_EQ(found[0].remedies.at(1), "a larger aiding.gnss.estimate.lever_arm");
}

TEST_F(GivenValues, OfAStartThatLiesElsewhereNothingIsKnown) {
  start_.x.t += 1.0;
  EXPECT_TRUE(Find(2, 30.0).empty());
}

/// Measured = (1 + scale) true: a scale below -1 counts backwards.
TEST_F(GivenValues, ASpeedOfTheWrongSignIsSaidToBeOne) {
  Solution solution;
  solution.layout = TypicalLayout();
  Block block;
  block.key = {BlockKind::kScale, 0};
  block.name = "wheel_scale";
  block.unit = "1";
  block.evolution = Evolution::Constant();
  block.sigma0.setConstant(0.05);
  solution.layout.Add(block);
  start_.P = solution.layout.InitialCovariance();
  start_.x.parameters =
      ParameterVector::Zero(solution.layout.parameter_count());
  const auto find = [&](double scale) {
    State x = start_.x;
    x.parameters.setConstant(scale);
    solution.states = {x};
    std::vector<Evidence> found;
    FindStrainedValues({.solution = solution, .start = start_}, &found);
    return found;
  };
  const auto backwards = find(-2.0);
  ASSERT_EQ(backwards.size(), 1u);
  EXPECT_THAT(backwards[0].what, StartsWith("wheel_scale is 40.0 sigma"));
  EXPECT_THAT(backwards[0].causes.at(0), HasSubstr("wrong sign"));
  EXPECT_THAT(backwards[0].remedies.at(0), HasSubstr("leading \"-\""));
  EXPECT_THAT(find(-0.5).at(0).causes.at(0), Not(HasSubstr("wrong sign")));
}

}  // namespace
}  // namespace hindsight
