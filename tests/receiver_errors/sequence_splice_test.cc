#include "receiver_errors/sequence_splice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "filters/forward_filter.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::MakeProblem;
using testing::TacticalNoise;
using testing::TestProblem;
using testing::TestProblemOptions;
using testing::TypicalLayout;

/// A fix of the receiver at every `every`-th node; velocities at all if
/// `velocities`. `outliers` are fixes that are `off` [m].
LinearTape MakeTape(double duration, std::size_t every, bool velocities,
                    const std::vector<std::size_t>& outliers = {},
                    double off = 12.0) {
  TestProblemOptions options;
  options.noise = TacticalNoise(true);
  options.layout = TypicalLayout(options.noise);
  options.errors = true;
  options.duration = duration;
  options.position_sigma = 0.5;
  options.velocity_sigma = velocities ? 0.1 : 0.0;
  TestProblem problem = MakeProblem(options, 5);
  GateDecisions used(problem.measurements.size(), 1);
  std::size_t node = 0;
  std::size_t fix = 0;
  for (std::size_t i = 0; i < problem.measurements.size(); ++i) {
    if (problem.measurements[i].sensor != 0) continue;
    used[i] = node++ % every == 0;
    if (!used[i]) continue;
    if (std::find(outliers.begin(), outliers.end(), fix++) != outliers.end()) {
      auto& position = std::get<PositionFix>(problem.measurements[i].model);
      position.p_e += NedAxes(position.p_e) * Eigen::Vector3d(off, 0.0, 0.0);
    }
  }
  Problem posed = problem.Pose(used);
  return RunLinearizedFilter(problem.truth, &posed);
}

ErrorParameters Parameters(double outlier_share) {
  ErrorParameters p;
  p.outlier_share = outlier_share;
  p.sigma = 3.0;
  p.tau = 300.0;
  return p;
}

std::size_t FixCount(const LinearTape& tape) {
  std::size_t fixes = 0;
  for (std::size_t k = 0; k < tape.size(); ++k) fixes += HasFix(tape, k, 0);
  return fixes;
}

/// Steps that may follow each other; each changes something with probability
/// `change`.
void Redraw(std::size_t begin, std::size_t end, double change,
            std::mt19937* random, ModeSequence* h) {
  std::uniform_real_distribution<double> uniform;
  for (std::size_t i = begin; i < end; ++i) {
    const ErrorMode before = i == 0 ? ErrorMode::kGood : (*h)[i - 1].mode;
    const std::vector<ErrorStep> steps = StepsAfter(before);
    (*h)[i] = uniform(*random) < change ? steps[(*random)() % steps.size()]
                                        : ErrorStep{before};
  }
  // What follows has to be able to.
  for (std::size_t i = end; i < h->size(); ++i) {
    const ErrorMode before = i == 0 ? ErrorMode::kGood : (*h)[i - 1].mode;
    const std::vector<ErrorStep> steps = StepsAfter(before);
    if (std::find(steps.begin(), steps.end(), (*h)[i]) != steps.end()) break;
    (*h)[i] = {before};
  }
}

/// A bias, a velocity_step, a drift and another bias.
ModeSequence Base(std::size_t fixes) {
  ModeSequence h(fixes);
  for (std::size_t i = 15; i < 25; ++i) h[i] = {ErrorMode::kBiased, i == 15};
  h[30].velocity_step = true;
  for (std::size_t i = 36; i < 44; ++i) h[i] = {ErrorMode::kDrifting, i == 36};
  for (std::size_t i = 44; i < 50; ++i) h[i] = {ErrorMode::kBiased};
  return h;
}

void ExpectSame(const SequenceScore& a, const SequenceScore& b,
                double tolerance) {
  EXPECT_NEAR(a.log_likelihood, b.log_likelihood, tolerance);
  EXPECT_NEAR(a.log_prior, b.log_prior, 1e-9);
}

void ExpectScoresOfVariations(const LinearTape& tape, const ErrorParameters& p,
                              double tolerance, double base_tolerance = 1e-7) {
  const ModeSequence base = Base(FixCount(tape));
  const SensorTape seen(tape, 0);
  SequenceSplice splice(seen, p, base);
  ExpectSame(splice.Score(base), ScoreSequence(seen, p, base), base_tolerance);
  std::mt19937 random(2);
  for (int trial = 0; trial < 120; ++trial) {
    ModeSequence h = base;
    const std::size_t begin = random() % h.size();
    const std::size_t end = std::min(begin + 1 + random() % 10, h.size());
    Redraw(begin, end, 0.3, &random, &h);
    SCOPED_TRACE(::testing::Message()
                 << "trial " << trial << ", from fix " << begin);
    ExpectSame(splice.Score(h), ScoreSequence(seen, p, h), tolerance);
  }
}

TEST(SequenceSplice, WithoutOutliersIsScoreSequence) {
  ExpectScoresOfVariations(MakeTape(70.0, 1, false), Parameters(1e-15), 1e-6);
}

TEST(SequenceSplice, WithNodesBetweenFixesIsScoreSequence) {
  ExpectScoresOfVariations(MakeTape(240.0, 4, true), Parameters(1e-15), 1e-6);
}

// A fix is either an outlier or not: the excess depends on the decision alone.
TEST(SequenceSplice, WithCertainOutliersIsScoreSequence) {
  ExpectScoresOfVariations(MakeTape(70.0, 1, false, {5, 33, 55}),
                           Parameters(1e-15), 1e-6);
}

TEST(SequenceSplice, WithOutliersIsScoreSequenceButForLaterExcesses) {
  ExpectScoresOfVariations(MakeTape(70.0, 1, false, {5, 33, 55}),
                           Parameters(0.02), 1e-2);
  ExpectScoresOfVariations(MakeTape(240.0, 4, true, {5, 33, 55}),
                           Parameters(0.02), 1e-2);
}

TEST(SequenceSplice, TakesChangesAtTheFirstAndTheLastFix) {
  const LinearTape tape = MakeTape(243.0, 4, true);  // nodes after the last fix
  const ErrorParameters p = Parameters(1e-15);
  const ModeSequence base = Base(FixCount(tape));
  const SensorTape seen(tape, 0);
  SequenceSplice splice(seen, p, base);
  for (const ErrorStep step : StepsAfter(ErrorMode::kGood)) {
    for (const std::size_t i : {std::size_t{0}, base.size() - 1}) {
      ModeSequence h = base;
      h[i] = step;
      ExpectSame(splice.Score(h), ScoreSequence(seen, p, h), 1e-6);
    }
    ModeSequence both = base;
    both.front() = step;
    both.back() = step;
    ExpectSame(splice.Score(both), ScoreSequence(seen, p, both), 1e-6);
  }
}

/// Runs of outliers, near and far, in a base that takes none or some of them for such:
/// whatever is better by its score may be.
TEST(SequenceSplice, WhatIsBetterMayBe) {
  int refused = 0;
  int better = 0;
  for (const double off : {3.0, 12.0}) {
    std::vector<std::size_t> outliers;
    for (std::size_t i = 5; i < 130; i += 31) {
      for (std::size_t j = 0; j <= i % 3; ++j) outliers.push_back(i + j);
    }
    const LinearTape tape = MakeTape(140.0, 1, false, outliers, off);
    const SensorTape seen(tape, 0);
    for (const auto& [share, ratio] :
         {std::pair{0.02, 3.0}, {0.02, 10.0}, {0.2, 10.0}}) {
      ErrorParameters p = Parameters(share);
      p.outlier_ratio = ratio;
      ModeSequence base(FixCount(tape));
      for (std::size_t i = 0; i < base.size(); i += 11) base[i].outlier = true;
      for (const ModeSequence& from : {ModeSequence(base.size()), base}) {
        const SequenceSplice splice(seen, p, from);
        const double level = splice.Score(from).log_posterior();
        for (std::size_t i = 0; i < from.size(); ++i) {
          ModeSequence h = from;
          h[i].outlier = !h[i].outlier;
          const bool is_better = splice.Score(h).log_posterior() > level;
          const bool may_be = splice.MayBeBetter(h, i);
          better += is_better ? 1 : 0;
          refused += may_be ? 0 : 1;
          EXPECT_TRUE(may_be || !is_better) << off << " m, fix " << i;
        }
      }
    }
  }
  EXPECT_GT(better, 20);
  EXPECT_GT(refused, 100);
}

TEST(SequenceSplice, MovesAChange) {
  const LinearTape tape = MakeTape(240.0, 4, true);
  const ErrorParameters p = Parameters(1e-15);
  const ModeSequence base = Base(FixCount(tape));
  const SensorTape seen(tape, 0);
  SequenceSplice splice(seen, p, base);
  for (std::size_t begin = 7; begin < 24; ++begin) {
    ModeSequence h = base;
    for (std::size_t i = 7; i < 25; ++i) {
      h[i] = {i < begin ? ErrorMode::kGood : ErrorMode::kBiased, i == begin};
    }
    ExpectSame(splice.Score(h), ScoreSequence(seen, p, h), 1e-6);
  }
}

}  // namespace
}  // namespace hindsight
