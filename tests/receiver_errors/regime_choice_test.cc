#include "receiver_errors/regime_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "receiver_errors/receiver_tape.h"
#include "receiver_errors/uniform_regimes.h"

namespace hindsight {
namespace {

using testing::AddError;
using ::testing::DoubleEq;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::FieldsAre;
using testing::Good;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::Optional;
using testing::PositionsOnly;
using testing::TapeOf;
using testing::TestProblem;
using testing::WithoutOutliers;

ErrorRegimes Regime(const LinearTape& tape, ErrorRegimes::Kind kind,
                    double log_evidence) {
  ErrorRegimes out;
  out.kind = kind;
  out.log_evidence = log_evidence;
  Hypothesis one;
  one.sequence = Good(tape);
  one.parameters = WithoutOutliers();
  out.hypotheses = {one};
  return out;
}

using Kind = ErrorRegimes::Kind;

auto Open(double log_odds) {
  return Field(&OpenBias::log_odds, DoubleEq(log_odds));
}

/// Of positions of 0.5 m, with as much effort as is asked for.
struct Posed {
  explicit Posed(double duration) : Posed(PositionsOnly(duration)) {}
  explicit Posed(const TestProblem& test, double stated_sigma = 0.5)
      : tape(TapeOf(test)), problem{seen, stated_sigma, false, &effort} {}

  LinearTape tape;
  SensorTape seen{tape, 0};
  SearchEffort effort{1e9, nullptr};
  RegimeProblem problem;
};

auto Leaves(std::size_t index, double gain) {
  return FieldsAre(index, DoubleEq(gain));
}

TEST(RegimeChoice, NeedsOddsOfAThousand) {
  const Posed posed(30.0);
  for (const double gain : {6.8, 7.0}) {
    const RegimeChoice choice =
        ChooseRegime(posed.problem, {Regime(posed.tape, Kind::kStated, 0.0),
                                     Regime(posed.tape, Kind::kWhite, gain)});
    EXPECT_EQ(choice.chosen, gain > kLeastGain ? 1u : 0u);
  }
}

/// A stated sigma has slow errors in it: beside fixes and an IMU that are both better than
/// stated nothing tells whose what is slow is.
TEST(RegimeChoice, GaussMarkovErrorsNeedFixesOrAnImuAsStated) {
  const Posed posed(30.0);
  const auto choose = [&](double scale, double imu_scale) {
    ErrorRegimes slow = Regime(posed.tape, Kind::kGaussMarkov, 20.0);
    slow.hypotheses[0].parameters.scale = scale;
    slow.hypotheses[0].parameters.imu_scale = imu_scale;
    return ChooseRegime(posed.problem,
                        {Regime(posed.tape, Kind::kStated, 0.0),
                         Regime(posed.tape, Kind::kWhite, 1.0), slow});
  };
  EXPECT_EQ(choose(1.0, 1.0).chosen, 2u);
  // Of one alone it may be said that it predicts worse.
  for (const auto& [scale, imu_scale] :
       {std::pair{0.6, 0.1}, std::pair{0.2, 0.6}}) {
    EXPECT_THAT(choose(scale, imu_scale).refused,
                Each(Not(HasSubstr("take the fixes"))));
  }
  const RegimeChoice refused = choose(0.2, 0.1);
  EXPECT_EQ(refused.chosen, 0u);
  EXPECT_THAT(refused.refused,
              ElementsAre("Gauss-Markov errors do not stand: they take the "
                          "fixes for 0.2, the noise of the IMU for 0.1 times "
                          "as stated"));
}

TEST(RegimeChoice, LeavesUndecidedWhatIsWithinOddsOfAThousandOfNoise) {
  const Posed posed(30.0);
  const auto choose = [&](double white, double switching) {
    ErrorRegimes better = Regime(posed.tape, Kind::kWhite, white);
    // As no batch is solved: it does not stand, but is a rival to what does.
    better.hypotheses[0].parameters.scale = 0.5;
    return ChooseRegime(posed.problem,
                        {Regime(posed.tape, Kind::kStated, 0.0), better,
                         Regime(posed.tape, Kind::kSwitching, switching)});
  };
  EXPECT_THAT(choose(0.0, -7.0).undecided, IsEmpty());
  EXPECT_THAT(choose(0.0, 1.1).undecided, ElementsAre(Leaves(2, 1.1)));
  EXPECT_THAT(choose(10.0, 8.0).undecided, ElementsAre(Leaves(2, -2.0)));
  EXPECT_EQ(choose(0.0, 1.2).chosen, 2u);
  EXPECT_THAT(choose(0.0, 1.2).undecided, IsEmpty());
}

/// What is stated has no parameters, and wins over white noise by what these cost: that
/// there is a slow error beside noise is not less likely for it.
TEST(RegimeChoice, WeighsGaussMarkovErrorsAgainstWhiteNoise) {
  const Posed posed(30.0);
  const auto choose = [&](double gauss_markov) {
    ErrorRegimes slow = Regime(posed.tape, Kind::kGaussMarkov, gauss_markov);
    slow.slight = SlightBias{{}, 0.5 - kLogOddsOfSlowErrors};
    return ChooseRegime(posed.problem,
                        {Regime(posed.tape, Kind::kStated, 0.0),
                         Regime(posed.tape, Kind::kWhite, -6.0), slow});
  };
  EXPECT_THAT(choose(-13.0).undecided, IsEmpty());
  EXPECT_FALSE(choose(-13.5).open.has_value());
  EXPECT_THAT(choose(-7.0).undecided, ElementsAre(Leaves(2, -1.0)));
  EXPECT_THAT(choose(-7.0).open, Optional(Open(-0.5)));
  EXPECT_THAT(choose(6.0).open, Optional(Open(12.5)));
  EXPECT_EQ(choose(8.0).chosen, 2u);
  EXPECT_FALSE(choose(8.0).open.has_value());
}

/// However likely it is.
TEST(RegimeChoice, LeavesOpenWhatDoesNotStandForAnotherReason) {
  const Posed posed(30.0);
  ErrorRegimes slow = Regime(posed.tape, Kind::kGaussMarkov, 20.0);
  slow.hypotheses[0].parameters.scale = 0.2;
  slow.hypotheses[0].parameters.imu_scale = 0.1;
  slow.slight = SlightBias{{}, -kLogOddsOfSlowErrors};
  const RegimeChoice choice = ChooseRegime(
      posed.problem, {Regime(posed.tape, Kind::kStated, 0.0),
                      Regime(posed.tape, Kind::kWhite, 1.0), slow});
  EXPECT_EQ(choice.chosen, 0u);
  EXPECT_THAT(choice.open, Optional(Open(19.0)));
}

/// By covariances, which move nothing.
TEST(RegimeChoice, LeavesOpenWhatPredictsWorse) {
  const Posed posed(300.0);
  ErrorRegimes worse = Regime(posed.tape, Kind::kGaussMarkov, -1.0);
  worse.hypotheses[0].parameters.scale = 10.0;
  worse.slight = SlightBias{{}, -kLogOddsOfSlowErrors};
  const RegimeChoice choice = ChooseRegime(
      posed.problem, {Regime(posed.tape, Kind::kStated, 0.0),
                      Regime(posed.tape, Kind::kWhite, 0.0), worse});
  EXPECT_THAT(choice.undecided, IsEmpty());
  EXPECT_THAT(choice.open, Optional(Open(-1.0)));
}

TEST(RegimeChoice, LeavesTheLikeliestOfEachKindUndecided) {
  const Posed posed(30.0);
  EXPECT_THAT(
      ChooseRegime(posed.problem, {Regime(posed.tape, Kind::kStated, 0.0),
                                   Regime(posed.tape, Kind::kGaussMarkov, -3.0),
                                   Regime(posed.tape, Kind::kSwitching, -4.0),
                                   Regime(posed.tape, Kind::kSwitching, -2.0)})
          .undecided,
      ElementsAre(Leaves(3, -2.0), Leaves(1, -3.0)));
}

TEST(RegimeChoice, NeedsOddsOfAThousandBesideAnEstimatedClock) {
  const LinearTape tape = TapeOf(PositionsOnly(30.0));
  const SensorTape seen(tape, 0);
  SearchEffort effort(1e9, nullptr);
  for (const bool has_clock : {false, true}) {
    const RegimeProblem problem{.tape = seen,
                                .stated_sigma = 0.5,
                                .effort = &effort,
                                .has_clock = has_clock};
    const RegimeChoice choice =
        ChooseRegime(problem, {Regime(tape, Kind::kStated, 0.0),
                               Regime(tape, Kind::kSwitching, 3.0)});
    EXPECT_EQ(choice.chosen, has_clock ? 0u : 1u);
    EXPECT_EQ(choice.undecided.size(), has_clock ? 1u : 0u);
  }
}

TEST(RegimeChoice, RefusesAValueAtItsBoundWhateverTheEvidence) {
  const Posed posed(30.0);
  ErrorRegimes white = Regime(posed.tape, Kind::kWhite, 1000.0);
  white.hypotheses[0].parameters.scale = 0.1;
  const RegimeChoice choice = ChooseRegime(
      posed.problem, {Regime(posed.tape, Kind::kStated, 0.0), white});
  EXPECT_EQ(choice.chosen, 0u);
  ASSERT_EQ(choice.refused.size(), 1u);
  EXPECT_NE(choice.refused[0].find("at its bound"), std::string::npos);
}

/// A constraint may hold exactly, whatever its tolerance.
TEST(RegimeChoice, AsksNothingOfTheLeastFactorOnATolerance) {
  const LinearTape tape = TapeOf(PositionsOnly(30.0));
  const SensorTape seen(tape, 0);
  SearchEffort effort(1e9, nullptr);
  ErrorRegimes switching = Regime(tape, Kind::kSwitching, 1000.0);
  for (const double scale : {0.1, 100.0}) {
    switching.hypotheses[0].parameters.scale = scale;
    for (const bool is_tolerance : {false, true}) {
      const RegimeProblem problem{.tape = seen,
                                  .stated_sigma = 0.5,
                                  .effort = &effort,
                                  .is_tolerance = is_tolerance};
      const RegimeChoice choice =
          ChooseRegime(problem, {Regime(tape, Kind::kStated, 0.0), switching});
      const bool bounded = !choice.refused.empty() &&
                           choice.refused[0].find("bound") != std::string::npos;
      EXPECT_EQ(bounded, !is_tolerance || scale > 1.0) << scale;
    }
  }
}

TEST(RegimeChoice, RefusesWhiteErrorsThatNoBatchIsSolvedWith) {
  const Posed posed(30.0);
  ErrorRegimes white = Regime(posed.tape, Kind::kWhite, 1000.0);
  white.hypotheses[0].parameters.scale = 0.5;
  const RegimeChoice choice = ChooseRegime(
      posed.problem, {Regime(posed.tape, Kind::kStated, 0.0), white,
                      Regime(posed.tape, Kind::kWhite, 3.0)});
  EXPECT_EQ(choice.chosen, 0u);
  ASSERT_EQ(choice.refused.size(), 1u);
  EXPECT_NE(choice.refused[0].find("take the fixes for 0.5"),
            std::string::npos);
}

/// Better than stated by half, and no outliers: there is nothing to solve with.
TEST(FitNoise, OfFixesBetterThanStatedIsThereAsTheBatchIsSolvedWith) {
  TestProblem test = PositionsOnly(120.0);
  for (Measurement& z : test.measurements) {
    std::get<PositionFix>(z.model).R_n *= 9.0;
  }
  const Posed posed(test, 1.5);
  const std::vector<ErrorRegimes> all = FitNoise(posed.problem);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_LT(all[1].hypotheses[0].parameters.scale, 0.5);
  EXPECT_EQ(all[2].hypotheses[0].parameters.scale, 1.0);
  EXPECT_EQ(all[2].hypotheses[0].parameters.imu_scale, 1.0);
  EXPECT_GT(all[1].log_evidence - all[0].log_evidence, kLeastGain);
  EXPECT_LT(all[2].log_evidence - all[0].log_evidence, kLeastGain);
  EXPECT_EQ(ChooseRegime(posed.problem, all).chosen, 0u);
}

/// Where only noise is sought, what cannot stand costs no integral, and is refused
/// as with one.
TEST(FitNoise, DoesNotIntegrateWhatCannotStand) {
  const LinearTape tape = TapeOf(PositionsOnly(120.0));
  SearchEffort all_effort(1e9, nullptr);
  SearchEffort effort(1e9, nullptr);
  const SensorTape seen(tape, 0);
  const RegimeProblem all{seen, 0.5, false, &all_effort};
  const RegimeProblem noise{seen, 0.5, true, &effort};
  const std::vector<ErrorRegimes> integrated = FitNoise(all);
  const std::vector<ErrorRegimes> bounded = FitNoise(noise);
  ASSERT_LT(integrated[1].log_evidence - integrated[0].log_evidence,
            kLeastGain);
  ASSERT_EQ(bounded.size(), integrated.size());
  EXPECT_LT(bounded[1].log_evidence - bounded[0].log_evidence, kLeastGain);
  EXPECT_GE(bounded[1].log_evidence, integrated[1].log_evidence);
  EXPECT_EQ(ChooseRegime(noise, bounded).chosen, 0u);
  EXPECT_LT(effort.spent(), 0.9 * all_effort.spent());
}

TEST(RegimeChoice, RefusesWhatPredictsHeldOutStretchesWorse) {
  const Posed posed(90.0);
  ErrorRegimes absurd = Regime(posed.tape, Kind::kSwitching, 1000.0);
  absurd.hypotheses[0].parameters.scale = 0.12;
  absurd.hypotheses[0].parameters.rate_sigma = 1.0;
  for (ErrorStep& step : absurd.hypotheses[0].sequence) {
    step.velocity_step = true;
  }
  const RegimeChoice choice = ChooseRegime(
      posed.problem, {Regime(posed.tape, Kind::kStated, 0.0), absurd});
  EXPECT_EQ(choice.chosen, 0u);
  ASSERT_EQ(choice.refused.size(), 1u);
  EXPECT_NE(choice.refused[0].find("held-out"), std::string::npos);
}

TEST(VelocitySteps, CostMoreTheMoreThereAre) {
  EXPECT_EQ(LogOfVelocitySteps(0), 0.0);
  EXPECT_EQ(LogOfVelocitySteps(1), 0.0);
  EXPECT_NEAR(LogOfVelocitySteps(3), -3.0 * std::log(100.0), 1e-9);
  // No evidence of a recording outweighs twenty.
  EXPECT_LT(LogOfVelocitySteps(20), -800.0);
}

TEST(FindRegimes, OfAnEndedSearchAreWhatThereIsByThen) {
  TestProblem test = PositionsOnly(60.0);
  AddError(20, 30, {8.0, -8.0, 0.0}, &test);
  const LinearTape tape = TapeOf(test);
  int calls = 0;
  SearchEffort effort(1e9, [&](double) { return ++calls < 5; });
  const SensorTape seen(tape, 0);
  const RegimeProblem problem{seen, 0.5, false, &effort};
  const std::vector<ErrorRegimes> all = FitRegimes(problem);
  EXPECT_TRUE(effort.stopped());
  EXPECT_EQ(calls, 5);
  ASSERT_GE(all.size(), 3u);
  EXPECT_EQ(all[0].kind, Kind::kStated);
}

}  // namespace
}  // namespace hindsight
