#include "receiver_errors/bias_ridge.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "receiver_errors/error_tuning.h"
#include "receiver_errors/receiver_tape.h"
#include "receiver_errors/sequence_smoother.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::MakeProblem;
using testing::OfPositions;
using testing::TapeOf;
using testing::TestProblem;

constexpr double kFixSigma = 2.0;  // [m]

/// Fixes with Gauss-Markov errors from the first to the last.
LinearTape TapeWithErrors(double sigma, double tau) {
  TestProblem problem = MakeProblem(OfPositions(300.0, kFixSigma), 7);
  Random random(19);
  Eigen::Vector3d e = sigma * random.NormalVector3();
  const double a = std::exp(-1.0 / tau);
  for (Measurement& z : problem.measurements) {
    auto& fix = std::get<PositionFix>(z.model);
    e = a * e + sigma * std::sqrt(1.0 - a * a) * random.NormalVector3();
    fix.p_e += NedAxes(fix.p_e) * (e + kFixSigma * random.NormalVector3());
  }
  return TapeOf(problem);
}

/// What a tape tells of a bias throughout.
struct Told {
  BiasRange range;
  double log_odds = 0.0;  ///< of the likeliest against what was found
};

Told TellOf(const LinearTape& tape, const ErrorParameters& from) {
  ModeSequence biased(301, {.mode = ErrorMode::kBiased});
  biased.front().anew = true;
  const ErrorParameters found = TuneParameters({tape, 0}, biased, from);
  Told told{.range = FollowBias({tape, 0}, biased, found, from)};
  const auto posterior = [&](const ErrorParameters& p) {
    return ScoreSequence({tape, 0}, p, biased).log_likelihood +
           LogPriorOf(biased, p, from);
  };
  told.log_odds = posterior(told.range.likeliest) - posterior(found);
  return told;
}

TEST(FollowBias, GoesAsFarAsTheDataLeaveOpen) {
  ErrorParameters from;
  from.sigma = kFixSigma;
  from.tau = 100.0;
  // The IMU tells all of an error that changes within seconds.
  const Told fast = TellOf(TapeWithErrors(5.0 * kFixSigma, 3.0), from);
  EXPECT_GE(fast.log_odds, 0.0);
  EXPECT_NEAR(fast.range.likeliest.tau, 3.0, 2.0);
  EXPECT_LT(fast.range.mean.sigma, 1.3 * fast.range.likeliest.sigma);
  // Of one of minutes but the walk.
  const Told slow = TellOf(TapeWithErrors(5.0 * kFixSigma, 300.0), from);
  EXPECT_GE(slow.log_odds, 0.0);
  EXPECT_GT(slow.range.log_gain, 0.0);
  EXPECT_GT(slow.range.mean.sigma, 1.3 * slow.range.likeliest.sigma);
  const auto walk = [](const ErrorParameters& p) {
    return p.sigma * p.sigma / p.tau;
  };
  EXPECT_NEAR(std::log(walk(slow.range.mean) / walk(slow.range.likeliest)), 0.0,
              std::log(2.0));
}

}  // namespace
}  // namespace hindsight
