#include "receiver_errors/search_attempts.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "receiver_errors/error_tuning.h"
#include "receiver_errors/sequence_smoother.h"
#include "receiver_errors/sequence_variations.h"

namespace hindsight {
namespace {

bool IsAllGood(const ModeSequence& sequence) {
  return std::all_of(sequence.begin(), sequence.end(), [](const ErrorStep& s) {
    return s.mode == ErrorMode::kGood;
  });
}

/// Where the search for hypotheses begins: errors of several sizes, short or
/// lasting, first those as large as the outliers of `white`, and outliers as they are a
/// priori: those of white noise alone are the errors that are sought.
std::vector<ErrorParameters> Starts(const RegimeProblem& problem,
                                    const ErrorParameters& white) {
  constexpr double kRateTime = 100.0;
  constexpr double kSlight = 3.0;
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
    p.imu_scale = 1.0;
    p.outlier_share = typical.outlier_share;
    p.outlier_ratio = typical.outlier_ratio;
  }
  // What noise alone takes for outliers are the errors.
  const double size = white.scale * white.outlier_ratio * problem.stated_sigma;
  std::ranges::stable_sort(starts, {}, [size](const ErrorParameters& p) {
    return std::abs(std::log(p.sigma / size));
  });
  return starts;
}

double LogPosterior(const RegimeProblem& problem,
                    const ErrorParameters& parameters,
                    const ModeSequence& sequence) {
  const SequenceScore score =
      ScoreSequence(problem.tape, problem.sensor, parameters, sequence);
  return score.log_likelihood + score.log_prior;
}

/// The largest of the sensor's errors along an axis, smoothed.
double SizeOf(const RegimeProblem& problem, const Hypothesis& one) {
  const int n = problem.tape.dim();
  const ErrorTrajectory smoothed = SmoothSequence(problem.tape, problem.sensor,
                                                  one.parameters, one.sequence);
  Eigen::Vector3d largest = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < smoothed.size(); ++k) {
    largest = largest.cwiseMax(smoothed[k].segment<3>(n).cwiseAbs());
  }
  return largest.maxCoeff();
}

/// A fix as noise has it.
struct JudgedFix {
  double t = 0.0;
  double off = 0.0;  ///< root mean square of what is left of it, an axis
  bool outlier = false;
};

/// Of all fixes of the sensor.
std::vector<JudgedFix> JudgeFixes(const RegimeProblem& problem,
                                  const Hypothesis& noise) {
  constexpr double kOutlier = 5.0;  // sigma
  const LinearTape& tape = problem.tape;
  const ErrorTrajectory smoothed =
      SmoothSequence(tape, problem.sensor, noise.parameters, noise.sequence);
  std::vector<JudgedFix> fixes;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    for (const TapeMeasurement& z : tape.measurements(k)) {
      if (z.sensor != problem.sensor || !z.accepted || z.withheld) continue;
      const Eigen::VectorXd left =
          z.residual - z.H * smoothed[k].head(tape.dim());
      const Eigen::VectorXd sigmas = left.cwiseAbs().cwiseQuotient(
          z.R.diagonal().cwiseSqrt() * noise.parameters.scale);
      fixes.push_back(
          {tape.t(k), left.norm() / std::sqrt(static_cast<double>(left.size())),
           sigmas.maxCoeff() > kOutlier});
      break;
    }
  }
  return fixes;
}

/// Of fixes by time the first ones behind gaps, the first of all included, and past the
/// last.
std::vector<std::size_t> BeginsOfStretches(
    const std::vector<JudgedFix>& fixes) {
  constexpr double kGap = 5.0;  // by the median interval
  std::vector<double> intervals;
  for (std::size_t i = 1; i < fixes.size(); ++i) {
    intervals.push_back(fixes[i].t - fixes[i - 1].t);
  }
  std::vector<double> sorted = intervals;
  const auto middle =
      sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  std::vector<std::size_t> begins = {0};
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    if (intervals[i] > kGap * *middle) begins.push_back(i + 1);
  }
  begins.push_back(fixes.size());
  return begins;
}

/// Mean time between fixes [s].
double Spacing(const RegimeProblem& problem, std::size_t fixes) {
  const double duration =
      problem.tape.t(problem.tape.size() - 1) - problem.tape.t(0);
  return duration / static_cast<double>(std::max<std::size_t>(1, fixes));
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
      ModeSequence found = SearchHypotheses(problem.tape, problem.sensor,
                                            parameters, kNarrow, problem.effort)
                               .front()
                               .sequence;
      if (IsAllGood(found) || is_known(found)) break;
      parameters = TuneParameters(problem.tape, problem.sensor, found,
                                  parameters, problem.effort);
      const double log_posterior = LogPosterior(problem, parameters, found);
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
    ErrorTrajectory trajectory = SmoothSequence(
        problem.tape, problem.sensor, attempt.parameters, attempt.sequence);
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

std::vector<Attempt> ExchangedRoles(const RegimeProblem& problem,
                                    const Hypothesis& jumping) {
  constexpr double kLasting = 1e8;  // correlation time of a bias that stays [s]
  std::vector<Attempt> all;
  for (ModeSequence& other : RolesExchanged(jumping.sequence)) {
    ErrorParameters p = jumping.parameters;
    p.sigma = SizeOf(problem, jumping);
    p.tau = kLasting;
    all.push_back({p, std::move(other)});
  }
  return all;
}

Attempt BestOutlierThatIsRight(const RegimeProblem& problem,
                               const Hypothesis& noise) {
  constexpr double kLasting = 1e8;  // correlation time of a bias that stays [s]
  Attempt best;
  const std::vector<JudgedFix> fixes = JudgeFixes(problem, noise);
  if (fixes.size() < 2 || fixes.size() != noise.sequence.size()) return best;
  const std::vector<std::size_t> begins = BeginsOfStretches(fixes);
  for (std::size_t s = 0; s + 1 < begins.size(); ++s) {
    const std::size_t begin = begins[s];
    const std::size_t past = begins[s + 1];
    if (past - begin < 2) continue;
    for (const std::size_t right : {begin, past - 1}) {
      if (!fixes[right].outlier) continue;
      ModeSequence sequence(fixes.size());
      for (std::size_t i = begin; i < past; ++i) {
        if (i != right) sequence[i].mode = ErrorMode::kBiased;
      }
      sequence[right == begin ? begin + 1 : begin].anew = true;
      ErrorParameters p;
      p.scale = noise.parameters.scale;
      p.sigma = fixes[right].off;
      p.tau = kLasting;
      problem.effort->Spend(problem.tape.size());
      const double log_posterior = LogPosterior(problem, p, sequence);
      if (best.sequence.empty() || log_posterior > best.log_posterior) {
        best = {p, std::move(sequence), log_posterior};
      }
    }
  }
  return best;
}

Attempt BestDriftThatEnds(const RegimeProblem& problem,
                          const Hypothesis& jumping) {
  Attempt best;
  const double size = SizeOf(problem, jumping);
  const double dt = Spacing(problem, jumping.sequence.size());
  for (ModeSequence& one : DriftsThatEnd(jumping.sequence)) {
    const auto drifts = std::count_if(one.begin(), one.end(), [](auto& s) {
      return s.mode == ErrorMode::kDrifting;
    });
    ErrorParameters p = jumping.parameters;
    p.rate_sigma = size / (static_cast<double>(drifts) * dt);
    p.imu_scale = 1.0;
    problem.effort->Spend(problem.tape.size());
    const double log_posterior = LogPosterior(problem, p, one);
    if (best.sequence.empty() || log_posterior > best.log_posterior) {
      best = {p, std::move(one), log_posterior};
    }
  }
  return best;
}

}  // namespace hindsight
