#include "receiver_errors/mode_sequence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <utility>
#include <vector>

#include "filters/rts.h"
#include "receiver_errors/hidden_changes.h"
#include "receiver_errors/receiver_tape.h"
#include "receiver_errors/sequence_refinement.h"
#include "receiver_errors/sequence_smoother.h"
#include "receiver_errors/sequence_variations.h"

namespace hindsight {
namespace {

using testing::Good;
using testing::PositionsOnly;
using testing::TapeOf;
using testing::TestProblem;
using testing::WithoutOutliers;

TEST(ModeSequence, ThatIsGoodIsTheKalmanFilterAndItsSmoother) {
  const LinearTape tape = TapeOf(PositionsOnly(30.0));
  const ModeSequence good = Good(tape);
  double log_likelihood = 0.0;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    for (const TapeMeasurement& z : tape.measurements(k)) {
      log_likelihood += z.log_likelihood;
    }
  }
  const SequenceScore score = ScoreSequence({tape, 0}, WithoutOutliers(), good);
  EXPECT_NEAR(score.log_likelihood, log_likelihood,
              1e-6 * std::abs(log_likelihood));
  const ErrorTrajectory smoothed =
      SmoothSequence({tape, 0}, WithoutOutliers(), good);
  LinearTape copy = TapeOf(PositionsOnly(30.0));
  const SmoothedTrajectory rts = SmoothRts(std::move(copy));
  for (std::size_t k = 0; k < tape.size(); ++k) {
    const ErrorVector sigma = rts.P.Get(k).diagonal().cwiseSqrt();
    const ErrorVector difference = smoothed[k].head(tape.dim()) - rts.d[k];
    EXPECT_LT((difference.array() / sigma.array()).abs().maxCoeff(), 1e-5) << k;
    EXPECT_TRUE(smoothed[k].tail(6).isZero(0.0));
  }
}

/// One of the ways in which a receiver may begin it does, errs in one recording of
/// twelve, and is twice to three times as likely to err over a stretch at the end
/// as over the same at the begin.
TEST(ModeSequence, BeginsWellInElevenOfTwelveRecordings) {
  const auto first = [](ErrorMode mode, bool anew) {
    return std::exp(LogFirst({mode, anew, false}, 0.01));
  };
  const double well =
      first(ErrorMode::kGood, false) + first(ErrorMode::kSlight, true);
  const double erring =
      first(ErrorMode::kBiased, true) + first(ErrorMode::kDrifting, true);
  EXPECT_NEAR(well, 11.0 / 12.0, 1e-12);
  EXPECT_NEAR(erring, 1.0 / 12.0, 1e-12);

  constexpr int kFixes = 100;
  ModeSequence begin(kFixes);
  ModeSequence end(kFixes);
  for (int i = 0; i < kFixes / 2; ++i) {
    const auto k = static_cast<std::size_t>(i);
    begin[k].mode = ErrorMode::kBiased;
    end[k + kFixes / 2].mode = ErrorMode::kBiased;
  }
  begin.front().anew = true;
  end[kFixes / 2].anew = true;
  const auto log_prior = [](const ModeSequence& h) {
    double sum = LogFirst(h.front(), 1.0 / kFixes);
    for (std::size_t i = 1; i < h.size(); ++i) {
      sum += LogTransition(h[i - 1].mode, h[i], 1.0 / kFixes);
    }
    return sum;
  };
  // Half of the fixes go on in each mode, but one, in either.
  EXPECT_NEAR(log_prior(end) - log_prior(begin), LogOddsOfBeginningWell(), 0.1);
  EXPECT_GT(LogOddsOfBeginningWell(), std::log(2.0));
  EXPECT_LT(LogOddsOfBeginningWell(), std::log(3.0));
}

/// Whatever a mode, something comes after it; and as often as none of that happens over
/// a gap it happens over none of as many intervals between fixes.
TEST(ModeSequence, AGapIsAsManyIntervalsAsItLacks) {
  constexpr int kLacking = 15;
  constexpr double kShare = 0.01;
  for (const ErrorMode mode : {ErrorMode::kGood, ErrorMode::kBiased,
                               ErrorMode::kDrifting, ErrorMode::kSlight}) {
    double sum = 0.0;
    for (const ErrorStep& step : StepsAfter(mode)) {
      const double over_gap = LogTransition(mode, step, kLacking * kShare);
      sum += std::exp(over_gap);
      const double once = LogTransition(mode, step, kShare);
      if (step == ErrorStep{mode}) {
        EXPECT_NEAR(over_gap, kLacking * once, 1e-12);
      } else {
        // Once at any of them, and nothing else.
        EXPECT_LT(over_gap, once + std::log(kLacking));
        EXPECT_GT(over_gap, once + std::log(kLacking) +
                                LogTransition(mode, {mode}, kLacking * kShare));
      }
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
  }
}

/// A quarter of the time is as likely as another.
TEST(ModeSequence, AnOnsetInAQuarterIsAFourthAsLikely) {
  ErrorStep drift = {ErrorMode::kDrifting, true};
  ErrorStep velocity = {ErrorMode::kSlight, false, true};
  for (ErrorStep* step : {&drift, &velocity}) {
    const double first = LogFirst(*step, 0.01);
    const double later = LogTransition(ErrorMode::kSlight, *step, 0.01);
    for (const Onset onset :
         {Onset::kFirst, Onset::kSecond, Onset::kThird, Onset::kFourth}) {
      step->onset = onset;
      EXPECT_NEAR(LogFirst(*step, 0.01), first - std::log(4.0), 1e-12);
      EXPECT_NEAR(LogTransition(ErrorMode::kSlight, *step, 0.01),
                  later - std::log(4.0), 1e-12);
    }
  }
}

/// Of a drift and of a velocity step alone: what else is done leaves none behind, by which
/// equal sequences would differ.
TEST(ModeSequence, OnlyWhatBeginsHasAnOnset) {
  ModeSequence h(60);
  for (std::size_t i = 20; i < 40; ++i) h[i] = {ErrorMode::kDrifting, i == 20};
  h[20].onset = Onset::kThird;
  h[50].velocity_step = true;
  h[50].onset = Onset::kFourth;
  std::size_t onsets = 0;
  std::vector<ModeSequence> all = Variations(h);
  const auto take = [&all](const ModeSequence& one) {
    all.push_back(one);
    return true;
  };
  ForEachVelocityStep(h, take);
  ForEachEarlierError(h, [&](const auto& one, double) { return take(one); });
  for (const ModeSequence& one : HiddenChanges(h, {10, 30, 45}))
    all.push_back(one);
  for (const ModeSequence& one : all) {
    for (const ErrorStep& step : one) {
      EXPECT_TRUE(step.onset == Onset::kUsual || BeginsAtSomeTime(step));
      onsets += step.onset != Onset::kUsual;
    }
  }
  EXPECT_GT(onsets, all.size());
  const ErrorStep without = WithoutVelocityStep(h[50]);
  EXPECT_EQ(without, ErrorStep{});
  EXPECT_EQ(WithoutVelocityStep(h[20]), h[20]);
}

/// Good, biased from the third fix on: or biased before, and then good.
TEST(ModeSequence, ExchangesTheRolesOfAnErrantEnd) {
  ModeSequence h(5);
  for (std::size_t i = 3; i < 5; ++i) h[i].mode = ErrorMode::kBiased;
  h[3].anew = true;
  const std::vector<ModeSequence> all = RolesExchanged(h);
  ASSERT_EQ(all.size(), 1u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(all[0][i].mode, i < 3 ? ErrorMode::kBiased : ErrorMode::kGood);
    EXPECT_EQ(all[0][i].anew, i == 0);
  }
  const std::vector<ModeSequence> back = RolesExchanged(all[0]);
  ASSERT_EQ(back.size(), 1u);
  EXPECT_EQ(back[0], h);
  EXPECT_TRUE(RolesExchanged(ModeSequence(5)).empty());
  EXPECT_TRUE(
      RolesExchanged(ModeSequence(5, ErrorStep{ErrorMode::kBiased})).empty());
}

/// A jump to a bias that stays, and one from a bias that was there at first, may
/// each be the end of a drift; one of neither kind is not.
TEST(ModeSequence, TellsAJumpAsTheEndOfADrift) {
  ModeSequence end(12);
  ModeSequence begin(12);
  for (std::size_t i = 0; i < 12; ++i) {
    (i < 8 ? begin : end)[i].mode = ErrorMode::kBiased;
  }
  end[8].anew = true;
  end[3].velocity_step = true;
  begin[0].anew = true;
  // Lengths of 5 and 7 fixes, a quarter more.
  for (const ModeSequence& jump : {end, begin}) {
    const std::vector<ModeSequence> all = DriftsThatEnd(jump);
    ASSERT_EQ(all.size(), 2u);
    for (std::size_t i = 0; i < 12; ++i) {
      EXPECT_EQ(all[0][i].mode == ErrorMode::kDrifting, i >= 3 && i < 8) << i;
      EXPECT_EQ(all[1][i].mode == ErrorMode::kDrifting, i >= 1 && i < 8) << i;
      EXPECT_FALSE(all[0][i].velocity_step);
    }
    EXPECT_TRUE(all[0][3].anew);
    EXPECT_EQ(all[0][8].mode, ErrorMode::kGood);
  }
  ModeSequence pulse(12);
  for (std::size_t i = 4; i < 8; ++i) pulse[i].mode = ErrorMode::kBiased;
  pulse[4].anew = true;
  EXPECT_TRUE(DriftsThatEnd(pulse).empty());
  EXPECT_TRUE(DriftsThatEnd(ModeSequence(12)).empty());
}

/// A slight bias is a bias: by fixes alone it may as well be the other way about.
TEST(ModeSequence, TellsAJumpToASlightBiasInOtherWays) {
  ModeSequence h(12);
  for (std::size_t i = 0; i < 8; ++i) h[i].mode = ErrorMode::kSlight;
  h[0].anew = true;
  const std::vector<ModeSequence> all = RolesExchanged(h);
  ASSERT_EQ(all.size(), 1u);
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(all[0][i].mode, i < 8 ? ErrorMode::kGood : ErrorMode::kBiased);
  }
  EXPECT_EQ(DriftsThatEnd(h).size(), 2u);
}

TEST(ModeSequence, FindsWhenABiasBeginsAndEnds) {
  TestProblem problem = PositionsOnly(60.0);
  for (std::size_t k = 20; k < 30; ++k) {
    auto& fix = std::get<PositionFix>(problem.measurements[k].model);
    fix.p_e += NedAxes(fix.p_e) * Eigen::Vector3d(8.0, -8.0, 0.0);
  }
  const LinearTape tape = TapeOf(problem);
  const std::vector<Hypothesis> found =
      RefineHypotheses({tape, 0}, WithoutOutliers(),
                       SearchHypotheses({tape, 0}, WithoutOutliers()));
  ModeSequence expected = Good(tape);
  for (std::size_t i = 20; i < 30; ++i) {
    expected[i] = {ErrorMode::kBiased, i == 20};
  }
  EXPECT_EQ(found.front().sequence, expected);
  // Without the bias the sequence is next to impossible.
  const SequenceScore good =
      ScoreSequence({tape, 0}, WithoutOutliers(), Good(tape));
  EXPECT_LT(good.log_likelihood + good.log_prior,
            found.front().log_posterior - 100.0);
}

TEST(ModeSequence, RemembersADriftThatNoSingleFixShows) {
  TestProblem problem = PositionsOnly(90.0);
  constexpr double kRate = 0.4;  // less than a sigma from fix to fix
  for (std::size_t k = 20; k < 60; ++k) {
    auto& fix = std::get<PositionFix>(problem.measurements[k].model);
    fix.p_e +=
        NedAxes(fix.p_e) *
        Eigen::Vector3d(kRate * (static_cast<double>(k) - 20.0), 0.0, 0.0);
  }
  const LinearTape tape = TapeOf(problem);
  const std::vector<Hypothesis> found =
      SearchHypotheses({tape, 0}, WithoutOutliers());
  EXPECT_EQ(found.front().sequence[40].mode, ErrorMode::kDrifting);
  const ModeSequence best = ClimbSequences({tape, 0}, WithoutOutliers(), found);
  EXPECT_EQ(best[10].mode, ErrorMode::kGood);
  EXPECT_EQ(best[40].mode, ErrorMode::kDrifting);
  EXPECT_EQ(best[70].mode, ErrorMode::kGood);
}

/// Fixes of 0.5 m, none for 20 s, of which the first behind errs by less than what
/// the IMU leaves open, and two soon after alike.
struct SpikeBehindAGap {
  static constexpr std::size_t kFix = 30;
  TestProblem problem = PositionsOnly(90.0);
  std::optional<LinearTape> tape;

  SpikeBehindAGap() {
    GateDecisions used(problem.measurements.size(), 1);
    for (std::size_t k = kFix; k < 50; ++k) used[k] = 0;
    const Eigen::Vector3d error(4.0, -4.0, 0.0);
    for (const std::size_t k : {50u, 53u, 55u}) {
      testing::AddError(k, k + 1, error, &problem);
    }
    tape.emplace(TapeOf(problem, std::move(used)));
  }
};

TEST(ModeSequence, ASpikeBehindAGapIsToldByWhatComesAfter) {
  const SpikeBehindAGap gap;
  ErrorParameters p = WithoutOutliers();
  p.outlier_share = 0.05;
  p.outlier_ratio = 12.0;
  const ModeSequence good = Good(*gap.tape);
  ModeSequence right = good;
  right[gap.kFix].outlier = true;
  const double log_right =
      ScoreSequence({*gap.tape, 0}, p, right).log_likelihood;
  // Taken by its likelihood alone it is believed.
  EXPECT_LT(ScoreSequence({*gap.tape, 0}, p, good).log_likelihood,
            log_right - 10.0);
  EXPECT_EQ(ClimbOutliers({*gap.tape, 0}, p, good), right);
  ModeSequence one_too_many = right;
  one_too_many[10].outlier = true;
  EXPECT_EQ(ClimbOutliers({*gap.tape, 0}, p, one_too_many), right);
  const std::vector<Hypothesis> found = SearchHypotheses({*gap.tape, 0}, p);
  EXPECT_EQ(found.front().sequence, right);
}

/// One behind a gap may be the vehicle's being elsewhere than dead reckoning has it, also
/// beside errors before and after it.
TEST(ModeSequence, AVelocityStepIsTriedInPlaceOfEachError) {
  ModeSequence h(60);
  const auto err = [&h](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      h[i] = {ErrorMode::kBiased, i == begin};
    }
  };
  err(10, 20);
  err(30, 40);
  err(50, 60);
  h[35].velocity_step = true;
  const std::vector<ModeSequence> all = Variations(h);
  ModeSequence stepped = h;
  for (std::size_t i = 30; i < 40; ++i) {
    stepped[i] = {ErrorMode::kGood, false, i == 30 || i == 35};
  }
  EXPECT_EQ(std::ranges::count(all, stepped), 1);
  stepped[40].velocity_step = true;
  EXPECT_EQ(std::ranges::count(all, stepped), 1);
}

ModeSequence Biased(
    std::size_t size,
    std::initializer_list<std::pair<std::size_t, std::size_t>> stretches) {
  ModeSequence h(size);
  for (const auto& [begin, end] : stretches) {
    for (std::size_t i = begin; i < end; ++i) {
      h[i] = {ErrorMode::kBiased, i == begin};
    }
  }
  return h;
}

TEST(HiddenChanges, EndAnErrorBehindAGapOrBeginItThere) {
  const std::vector<std::size_t> behind_gaps = {10, 40};
  const auto holds = [&](const ModeSequence& of, const ModeSequence& one) {
    return std::ranges::count(HiddenChanges(of, behind_gaps), one) > 0;
  };
  const ModeSequence to_the_end = Biased(60, {{20, 60}});
  EXPECT_TRUE(holds(to_the_end, Biased(60, {{20, 40}})));
  EXPECT_TRUE(holds(to_the_end, Biased(60, {{10, 20}})));
  const ModeSequence from_the_begin = Biased(60, {{0, 20}});
  EXPECT_TRUE(holds(from_the_begin, Biased(60, {{10, 20}})));
  EXPECT_TRUE(holds(from_the_begin, Biased(60, {{20, 40}})));
  // Beside another error, which stays or was none.
  const ModeSequence two = Biased(60, {{0, 20}, {20, 60}});
  EXPECT_TRUE(holds(two, Biased(60, {{0, 20}, {20, 40}})));
  EXPECT_TRUE(holds(two, Biased(60, {{20, 40}})));
  EXPECT_TRUE(holds(two, Biased(60, {{20, 40}, {40, 60}})));
  EXPECT_TRUE(holds(two, Biased(60, {{10, 20}})));
  // Earlier or later, and nothing else.
  EXPECT_TRUE(holds(to_the_end, Biased(60, {{10, 60}})));
  EXPECT_TRUE(holds(to_the_end, Biased(60, {{40, 60}})));
  EXPECT_TRUE(holds(from_the_begin, Biased(60, {{0, 40}})));
  EXPECT_TRUE(holds(from_the_begin, Biased(60, {{0, 10}})));
  EXPECT_TRUE(holds(two, Biased(60, {{0, 40}, {40, 60}})));
  EXPECT_TRUE(holds(two, Biased(60, {{0, 10}, {10, 60}})));
  EXPECT_TRUE(HiddenChanges(two, {}).empty());
  EXPECT_TRUE(HiddenChanges(ModeSequence(60), behind_gaps).empty());
}

/// Whatever the IMU does meanwhile.
TEST(HiddenChanges, AChangeThatMovesLeavesStepsOfTheVelocity) {
  ModeSequence h = Biased(60, {{20, 60}});
  h[30].velocity_step = true;
  h[30].onset = Onset::kThird;
  h[15].velocity_step = true;
  for (const std::size_t gap : {10u, 40u}) {
    ModeSequence moved = Biased(60, {{gap, 60}});
    for (const std::size_t i : {15u, 30u}) {
      moved[i].velocity_step = true;
      moved[i].onset = h[i].onset;
    }
    EXPECT_EQ(std::ranges::count(HiddenChanges(h, {gap}), moved), 1) << gap;
  }
}

/// Also at the fixes between which it moves: of the end of an error, with which one may be.
TEST(HiddenChanges, AnEndThatMovesLeavesStepsOfTheVelocity) {
  for (const std::size_t gap : {10u, 40u}) {
    ModeSequence h = Biased(60, {{5, 20}});
    ModeSequence moved = Biased(60, {{5, gap}});
    for (ModeSequence* one : {&h, &moved}) {
      (*one)[20].velocity_step = true;
      (*one)[20].onset = Onset::kSecond;
      (*one)[gap].velocity_step = true;
      (*one)[gap].onset = Onset::kThird;
    }
    const std::vector<ModeSequence> all = HiddenChanges(h, {gap});
    EXPECT_EQ(std::ranges::count(all, moved), gap > 20 ? 1 : 2) << gap;
  }
}

/// When it did: what is told by another fix is scored by what it is off there.
TEST(ModeSequence, AStepOfTheVelocityBeginsWhenTheDriftDidInItsPlace) {
  ModeSequence drift(60);
  for (std::size_t i = 20; i < 40; ++i) {
    drift[i] = {ErrorMode::kDrifting, i == 20};
  }
  drift[20].onset = Onset::kThird;
  drift[30].velocity_step = true;
  drift[30].onset = Onset::kFourth;
  ModeSequence steps(60);
  for (const std::size_t i : {20u, 30u}) {
    steps[i].velocity_step = true;
    steps[i].onset = drift[i].onset;
  }
  EXPECT_GE(std::ranges::count(Variations(drift), steps), 1);
}

TEST(HiddenChanges, AreBehindTheNearestGaps) {
  std::vector<std::size_t> behind_gaps;
  for (std::size_t i = 5; i < 100; i += 5) behind_gaps.push_back(i);
  const std::vector<ModeSequence> all =
      HiddenChanges(Biased(100, {{50, 100}}), behind_gaps);
  EXPECT_EQ(all.size(), 16u);
  for (const std::size_t gap : {55u, 60u, 65u, 70u}) {
    EXPECT_EQ(std::ranges::count(all, Biased(100, {{gap, 100}})), 1);
    EXPECT_EQ(std::ranges::count(all, Biased(100, {{100 - gap, 100}})), 1);
    EXPECT_EQ(std::ranges::count(all, Biased(100, {{50, gap}})), 1);
    EXPECT_EQ(std::ranges::count(all, Biased(100, {{100 - gap, 50}})), 1);
  }
}

TEST(ModeSequence, AFixThatIsAnOutlierStaysOneInEveryVariation) {
  ModeSequence h(60);
  for (std::size_t i = 25; i < h.size(); ++i) {
    h[i] = {ErrorMode::kBiased, i == 25};
  }
  const std::vector<std::size_t> outliers = {22, 25, 40};
  for (const std::size_t i : outliers) h[i].outlier = true;
  std::vector<ModeSequence> all = Variations(h);
  for (auto* const more : {&RolesExchanged, &DriftsThatEnd}) {
    const std::vector<ModeSequence> others = more(h);
    all.insert(all.end(), others.begin(), others.end());
  }
  const std::vector<ModeSequence> hidden = HiddenChanges(h, {10, 50});
  all.insert(all.end(), hidden.begin(), hidden.end());
  ForEachEarlierError(h, [&all](const ModeSequence& one, double) {
    all.push_back(one);
    return true;
  });
  ASSERT_GT(all.size(), 30u);
  for (const ModeSequence& one : all) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < one.size(); ++i) {
      if (one[i].outlier) found.push_back(i);
    }
    EXPECT_EQ(found, outliers);
  }
}

}  // namespace
}  // namespace hindsight
