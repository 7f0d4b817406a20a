#include "receiver_errors/error_tuning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "receiver_errors/receiver_tape.h"
#include "receiver_errors/sequence_smoother.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::MakeProblem;
using testing::OfPositions;
using testing::TapeOf;
using testing::TestProblem;

constexpr double kStated = 2.0;  // [m]

struct NoisyFixes {
  TestProblem problem;
  std::vector<Eigen::Vector3d> errors;  ///< of the fixes, whitened
};

/// Fixes of 1.4 times the stated sigma; a tenth of them of six times that.
NoisyFixes MakeNoisyFixes() {
  NoisyFixes out{MakeProblem(OfPositions(600.0, kStated), 5), {}};
  Random random(17);
  for (Measurement& z : out.problem.measurements) {
    auto& fix = std::get<PositionFix>(z.model);
    const double sigma = random.Uniform() < 0.1 ? 6.0 * 1.4 : 1.4;
    out.errors.emplace_back(sigma * random.NormalVector3());
    fix.p_e += NedAxes(fix.p_e) * (kStated * out.errors.back());
  }
  return out;
}

/// Expectation-maximisation for the mixture of two normal densities of three
/// rows, from the errors themselves.
ErrorParameters ExpectAndMaximise(const std::vector<Eigen::Vector3d>& errors) {
  ErrorParameters p;
  const auto count = static_cast<double>(errors.size());
  for (int i = 0; i < 200; ++i) {
    double inliers = 0.0;
    double squares_in = 0.0;
    double squares_out = 0.0;
    for (const Eigen::Vector3d& e : errors) {
      const double s = e.squaredNorm() / (p.scale * p.scale);
      const double k = p.outlier_ratio;
      const double in = (1.0 - p.outlier_share) * std::exp(-0.5 * s);
      const double out =
          p.outlier_share * std::exp(-0.5 * s / (k * k)) / (k * k * k);
      const double responsibility = in / (in + out);
      inliers += responsibility;
      squares_in += responsibility * e.squaredNorm();
      squares_out += (1.0 - responsibility) * e.squaredNorm();
    }
    p.outlier_share = 1.0 - inliers / count;
    p.scale = std::sqrt(squares_in / (3.0 * inliers));
    p.outlier_ratio =
        std::sqrt(squares_out / (3.0 * (count - inliers))) / p.scale;
  }
  return p;
}

TEST(TuneParameters, AgreesWithExpectationMaximisationOnTheErrorsThemselves) {
  const NoisyFixes noisy = MakeNoisyFixes();
  const LinearTape tape = TapeOf(noisy.problem);
  const ModeSequence good(noisy.errors.size());
  const ErrorParameters tuned = TuneParameters({tape, 0}, good, {});
  const ErrorParameters em = ExpectAndMaximise(noisy.errors);
  EXPECT_NEAR(em.scale, 1.4, 0.1);
  EXPECT_NEAR(em.outlier_share, 0.1, 0.04);
  EXPECT_NEAR(em.outlier_ratio, 6.0, 1.0);
  // As fine as the search goes.
  EXPECT_NEAR(std::log(tuned.scale / em.scale), 0.0, std::log(1.08));
  EXPECT_NEAR(std::log(tuned.outlier_share / em.outlier_share), 0.0,
              std::log(1.3));
  EXPECT_NEAR(std::log(tuned.outlier_ratio / em.outlier_ratio), 0.0,
              std::log(1.3));
}

/// One parameter's logarithm on a grid.
struct Grid {
  double likeliest = 0.0;  ///< value of the parameter
  double log_share = 0.0;  ///< ln of the sum of the posterior, by its largest
                           ///< value and the sum of the prior
};

Grid OnGrid(const LinearTape& tape, const ModeSequence& sequence,
            const ErrorParameters& at, double ErrorParameters::*member,
            double least, double spread, double range) {
  constexpr double kStep = 0.03;
  Grid grid;
  double largest = -1e300;
  double posterior = 0.0;
  double prior = 0.0;
  for (double x = 0.0; x < range; x += kStep) {
    ErrorParameters p = at;
    p.*member = least * std::exp(x);
    const double value = ScoreSequence({tape, 0}, p, sequence).log_likelihood +
                         LogPriorOf(sequence, p, {});
    if (value > largest) {
      posterior *= std::exp(largest - value);
      largest = value;
      grid.likeliest = p.*member;
    }
    const double z = std::log(p.*member / (ErrorParameters().*member)) / spread;
    const double weight = x == 0.0 ? 0.5 : 1.0;
    posterior += weight * std::exp(value - largest);
    prior += weight * std::exp(-0.5 * z * z);
  }
  grid.log_share = std::log(posterior / prior);
  return grid;
}

/// Of each parameter by itself, against sums over a grid.
TEST(LogShareOfPrior, IsTheIntegralOverEachParameter) {
  const NoisyFixes noisy = MakeNoisyFixes();
  const LinearTape tape = TapeOf(noisy.problem);
  const ModeSequence good(noisy.errors.size());
  ErrorParameters p = TuneParameters({tape, 0}, good, {});
  // Its readings are exact.
  EXPECT_LT(p.imu_scale, 0.1);
  double sum = 0.0;
  for (int round = 0; round < 2; ++round) {
    sum = 0.0;
    const auto settle = [&](double ErrorParameters::*member, double least,
                            double spread, double range = 6.0) {
      const Grid grid = OnGrid(tape, good, p, member, least, spread, range);
      p.*member = grid.likeliest;
      sum += grid.log_share;
    };
    settle(&ErrorParameters::scale, 0.1, 0.7);
    settle(&ErrorParameters::outlier_share, 1e-3, 1.5);
    settle(&ErrorParameters::outlier_ratio, 3.0, 1.5);
    settle(&ErrorParameters::imu_scale, kLeastImuScale, 1.1, 9.0);
  }
  EXPECT_NEAR(LogShareOfPrior({tape, 0}, good, p, {}), sum, 4 * 0.2);
  EXPECT_LT(sum, -6.0);
}

/// Beside exact readings. Of one error throughout the two are told apart; of several
/// nothing but the stated noise tells what is slow from what the receiver is off by.
TEST(TuneParameters, LeaveAnImuAsStatedWhereErrorsFollowEachOtherThroughout) {
  const NoisyFixes noisy = MakeNoisyFixes();
  const LinearTape tape = TapeOf(noisy.problem);
  ModeSequence biased(noisy.errors.size(), {ErrorMode::kBiased});
  biased.front().anew = true;
  EXPECT_LT(TuneParameters({tape, 0}, biased, {}).imu_scale, 1.0);
  biased[biased.size() / 2].anew = true;
  EXPECT_EQ(TuneParameters({tape, 0}, biased, {}).imu_scale, 1.0);
  ErrorParameters of_white;
  of_white.imu_scale = 0.1;
  EXPECT_EQ(TuneParameters({tape, 0}, biased, of_white).imu_scale, 1.0);
  biased.back() = {ErrorMode::kGood};
  EXPECT_LT(TuneParameters({tape, 0}, biased, {}).imu_scale, 1.0);
}

TEST(TunablesOf, OneBiasHasASigmaDownOfItsOwn) {
  const auto has_down = [](const ModeSequence& sequence) {
    return std::ranges::count(TunablesOf(sequence, {}), &ErrorParameters::down,
                              &Tunable::member) == 1;
  };
  ModeSequence sequence(9);
  EXPECT_FALSE(has_down(sequence));
  for (std::size_t i = 3; i < 6; ++i) sequence[i].mode = ErrorMode::kBiased;
  sequence[3].anew = true;
  EXPECT_TRUE(has_down(sequence));
  sequence[5].anew = true;
  EXPECT_FALSE(has_down(sequence));
  sequence[5] = {ErrorMode::kSlight};
  EXPECT_FALSE(has_down(sequence));
}

/// Also of data that say nothing, in which the priors are all that is integrated.
TEST(LogShareOfPrior, IsNotAboveItsMost) {
  const NoisyFixes noisy = MakeNoisyFixes();
  const LinearTape tape = TapeOf(noisy.problem);
  const ModeSequence good(noisy.errors.size());
  for (const double least_scale : {kLeastScale, 1.0}) {
    const double most = MostOfLogShare(good, {}, least_scale);
    for (const double scale : {1.0, 3.0}) {
      ErrorParameters p;
      p.scale = scale;
      EXPECT_LE(LogShareOfPrior({tape, 0}, good, p, {}, least_scale), most);
    }
    EXPECT_LT(most, 2.0);
  }
  // No sensor 1 measures anything.
  EXPECT_NEAR(LogShareOfPrior({tape, 1}, good, {}, {}, 1.0), 0.0, 0.3);
}

}  // namespace
}  // namespace hindsight
