#include "receiver_errors/search_attempts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "receiver_errors/error_tuning.h"
#include "receiver_errors/sequence_smoother.h"

namespace hindsight {
namespace {

/// Where the search for hypotheses begins: errors of several sizes, short or
/// lasting, first those as large as the outliers of `white`, and outliers as they are a
/// priori: those of white noise alone are the errors that are sought.
std::vector<ErrorParameters> Starts(const RegimeProblem& problem,
                                    const ErrorParameters& white) {
  constexpr double kRateTime = 100.0;
  constexpr double kSlight = 3.0;
  constexpr double kQuieter = 0.25;
  const ErrorParameters typical;
  std::vector<ErrorParameters> starts;
  for (const auto& [size, tau] : {std::pair{5.0, 1e8},
                                  {5.0, 30.0},
                                  {50.0, 1e8},
                                  {50.0, 30.0},
                                  {500.0, 1e8}}) {
    ErrorParameters& p = starts.emplace_back(white);
    p.sigma = size * problem.stated_sigma;
    p.slight_sigma = kSlight * problem.stated_sigma;
    p.tau = tau;
    p.rate_sigma = p.sigma / kRateTime;
    p.imu_scale = std::min(1.0, white.imu_scale);
    p.outlier_share = typical.outlier_share;
    p.outlier_ratio = typical.outlier_ratio;
  }
  // What noise alone takes for outliers are the errors.
  const double size = white.scale * white.outlier_ratio * problem.stated_sigma;
  std::ranges::stable_sort(starts, {}, [size](const ErrorParameters& p) {
    return std::abs(std::log(p.sigma / size));
  });
  // Of an IMU that is better than stated a jump takes part of what it is better by.
  if (white.imu_scale < 1.0) {
    ErrorParameters quiet = starts.front();
    quiet.imu_scale = std::max(kLeastImuScale, kQuieter * quiet.imu_scale);
    starts.insert(starts.begin() + 1, quiet);
  }
  return starts;
}

}  // namespace

std::vector<Attempt> MakeAttempts(const RegimeProblem& problem,
                                  const ErrorParameters& white) {
  constexpr std::size_t kNarrow = 1;
  constexpr int kMostRounds = 3;
  constexpr double kClimbs = 0.5;  // of what is left: the rest refines attempts
  const double reserve = kClimbs * problem.effort->left();
  std::vector<Attempt> attempts;
  const auto is_known = [&](const ModeSequence& sequence) {
    return std::any_of(attempts.begin(), attempts.end(),
                       [&](const auto& a) { return a.sequence == sequence; });
  };
  for (ErrorParameters parameters : Starts(problem, white)) {
    for (int round = 0; round < kMostRounds; ++round) {
      if (problem.effort->left() <= reserve && !attempts.empty()) break;
      ModeSequence found =
          SearchHypotheses(problem.tape, parameters, kNarrow, problem.effort)
              .front()
              .sequence;
      if (IsGoodThroughout(found) || is_known(found)) break;
      parameters =
          TuneParameters(problem.tape, found, parameters, problem.effort);
      const double log_posterior =
          ScoreSequence(problem.tape, parameters, found).log_posterior();
      attempts.push_back({parameters, std::move(found), log_posterior});
    }
  }
  std::sort(attempts.begin(), attempts.end(), [](const auto& a, const auto& b) {
    return a.log_posterior > b.log_posterior;
  });
  return attempts;
}

std::vector<Attempt> Hopeful(std::vector<Attempt> attempts,
                             double log_posterior_of_white) {
  constexpr double kClimb = 10.0;
  std::erase_if(attempts, [&](const Attempt& one) {
    return one.log_posterior < log_posterior_of_white - kClimb;
  });
  return attempts;
}

std::vector<Attempt> BestAttempts(const RegimeProblem& problem,
                                  const std::vector<Attempt>& attempts) {
  constexpr std::size_t kMost = 3;
  constexpr double kLeastLog = 60.0;
  constexpr double kApart = 0.25;  // by the sigma of a fix
  std::vector<Attempt> best;
  std::vector<ErrorTrajectory> trajectories;
  for (const Attempt& attempt : attempts) {
    if (best.size() == kMost) break;
    if (attempt.log_posterior < attempts.front().log_posterior - kLeastLog) {
      break;
    }
    ErrorTrajectory trajectory =
        SmoothSequence(problem.tape, attempt.parameters, attempt.sequence);
    const double apart =
        kApart * attempt.parameters.scale * problem.stated_sigma;
    const bool known = std::any_of(
        trajectories.begin(), trajectories.end(), [&](const auto& t) {
          return MeanSquareDistance(t, trajectory) < apart * apart;
        });
    if (known) continue;
    best.push_back(attempt);
    trajectories.push_back(std::move(trajectory));
  }
  return best;
}

}  // namespace hindsight
