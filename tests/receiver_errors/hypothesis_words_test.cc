#include "receiver_errors/hypothesis_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hindsight {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr ErrorStep kGood = {ErrorMode::kGood};
constexpr ErrorStep kBiased = {ErrorMode::kBiased};
constexpr ErrorStep kDrifting = {ErrorMode::kDrifting};

TEST(HypothesisWords, NameBeginAndEndOfEveryPart) {
  const std::vector<ErrorStep> steps = {
      kGood,    {ErrorMode::kBiased, true},
      kBiased,  {ErrorMode::kBiased, true},
      kGood,    {ErrorMode::kGood, false, true},
      kGood,    {ErrorMode::kDrifting, true},
      kDrifting};
  EXPECT_EQ(
      DescribeSequence(steps, {0.0, 1.0, 2.0, 3.0, 4.5, 5.0, 6.0, 7.04, 8.0},
                       {{0.0, 3.0, 4.0, 8.2, 0.0, 0.0, 0.0, 5.0, 5.0}, "m"}),
      "biased from 1 to 3 s by 3.5 m, biased from 3 to 4.5 s by 8.2 m, the "
      "IMU's velocity steps at 5 s, drifting from 7 s to the end by up to 5 m");
}

TEST(HypothesisWords, TellAStopOfADriftFromItsEnd) {
  EXPECT_EQ(
      DescribeSequence({{ErrorMode::kDrifting, true}, kBiased, kGood},
                       {0.0, 10.0, 20.0}, {{1.0, 2.0, 0.0}, "uT"}),
      "drifting from 0 to 10 s by up to 1 uT, biased from 10 to 20 s by 2 uT");
  EXPECT_EQ(DescribeSequence({kGood, kGood}, {0.0, 1.0}, {{0.0, 0.0}, "m"}),
            "good throughout");
}

/// Of an error that changes more slowly than the recording lasts its walk.
TEST(HypothesisWords, SayOfErrorsWhatIsSeenOfThem) {
  ErrorParameters p;
  p.sigma = 3.0;
  p.tau = 200.0;
  const ModeSequence throughout = {kBiased, kBiased};
  EXPECT_THAT(
      DescribeErrors(throughout, p, "m", 300.0),
      ElementsAre("Gauss-Markov errors, sigma 3 m, correlation time 200 s"));
  EXPECT_THAT(DescribeErrors(throughout, p, "m", 100.0),
              ElementsAre("biases, sigma 3 m, that walk by 0.3 m/sqrt(s)"));
  EXPECT_THAT(DescribeErrors({kGood, kGood}, p, "m", 100.0), IsEmpty());
}

WeighedHypothesis Alternative(double weight, double north_at_end) {
  WeighedHypothesis one;
  one.weight = weight;
  one.steps.assign(2, kGood);
  one.smoothed = ErrorTrajectory(3, 2);
  one.smoothed[0].setZero();
  one.smoothed[1] << north_at_end, 0.0, 0.0;
  return one;
}

TEST(HypothesisWords, ARivalIsWhatMovesTheTrajectoryByThreeSigmas) {
  const std::vector<WeighedHypothesis> all = {
      Alternative(0.5, 0.0), Alternative(0.3, 0.29), Alternative(0.05, 0.31),
      Alternative(0.15, 4.0)};
  CovarianceSeries P(3, 2);
  for (std::size_t k = 0; k < 2; ++k) {
    P.Set(k, ErrorMatrix(0.01 * ErrorMatrix::Identity(3, 3)));
  }
  const RivalHypothesis rival = FindRival(all, all[0], P);
  EXPECT_EQ(rival.hypothesis, &all[3]);
  EXPECT_NEAR(rival.probability, 0.2, 1e-12);
  EXPECT_NEAR(rival.distance, 4.0, 1e-12);
  EXPECT_EQ(FindRival({all[0], all[1]}, all[0], P).hypothesis, nullptr);
}

TEST(HypothesisWords, SayOfARivalThatItIsLikelier) {
  const WeighedHypothesis other = Alternative(0.9996, 4.0);
  RivalHypothesis rival = {&other, 0.9996, 4.0};
  EXPECT_EQ(DescribeRival(rival, {0.0, 1.0}, 0, "m"),
            "likelier than that, with a probability of over 99.9 %, up to 4 m "
            "away: good throughout");
  rival.probability = 0.45;
  EXPECT_EQ(DescribeRival(rival, {0.0, 1.0}, 0, "m"),
            "or, with a probability of 45 %, up to 4 m away: good throughout");
}

/// At one of two nodes: 50 sigma^2 in the mean are 10 sigmas there.
TEST(HypothesisWords, ARivalBeyondWouldHaveANeesAbove25) {
  const std::vector<WeighedHypothesis> all = {
      Alternative(0.9, 0.0), Alternative(0.08, 0.70), Alternative(0.02, 0.72)};
  CovarianceSeries P(3, 2);
  for (std::size_t k = 0; k < 2; ++k) {
    P.Set(k, ErrorMatrix(0.01 * ErrorMatrix::Identity(3, 3)));
  }
  const RivalHypothesis beyond = FindRivalBeyond(all, all[0], P);
  EXPECT_EQ(beyond.hypothesis, &all[2]);
  EXPECT_NEAR(beyond.probability, 0.02, 1e-12);
}

TEST(HypothesisWords, TellTheNoiseOfTheImuWhereItIsNotAsStated) {
  ErrorParameters p;
  EXPECT_THAT(DescribeNoise(ErrorRegimes::Kind::kWhite, p),
              Not(HasSubstr("IMU")));
  p.imu_scale = 1.7;
  EXPECT_THAT(
      DescribeNoise(ErrorRegimes::Kind::kWhite, p),
      EndsWith("times that, beside noise of the IMU 1.7 times as stated"));
}

}  // namespace
}  // namespace hindsight
