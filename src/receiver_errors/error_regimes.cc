#include "receiver_errors/error_regimes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "receiver_errors/error_tuning.h"
#include "receiver_errors/history_attempts.h"
#include "receiver_errors/history_refinement.h"
#include "receiver_errors/history_smoother.h"

namespace hindsight {
namespace {

int FixCount(const RegimeProblem& problem) {
  int count = 0;
  for (std::size_t k = 0; k < problem.tape.size(); ++k) {
    if (HasFix(problem.tape, k, problem.receiver)) ++count;
  }
  return count;
}

ErrorHistory Uniform(const RegimeProblem& problem, ErrorMode mode) {
  return ErrorHistory(static_cast<std::size_t>(FixCount(problem)),
                      ErrorStep{mode, false});
}

ErrorParameters Tune(const RegimeProblem& problem, const ErrorHistory& history,
                     const ErrorParameters& from) {
  if (problem.poll) problem.poll();
  return TuneParameters(problem.tape, problem.receiver, history, from);
}

double Criterion(const RegimeProblem& problem, ErrorRegimes::Kind kind,
                 double log_posterior) {
  const int parameters = kind == ErrorRegimes::Kind::kWhite         ? 3
                         : kind == ErrorRegimes::Kind::kGaussMarkov ? 5
                                                                    : 8;
  return log_posterior -
         0.5 * parameters * std::log(std::max(2, FixCount(problem)));
}

/// White or Gauss-Markov throughout: there is but one history.
ErrorRegimes FitUniform(const RegimeProblem& problem, ErrorRegimes::Kind kind,
                        const ErrorParameters& from) {
  const ErrorMode mode = kind == ErrorRegimes::Kind::kWhite
                             ? ErrorMode::kGood
                             : ErrorMode::kBiased;
  ErrorHistory history = Uniform(problem, mode);
  if (mode == ErrorMode::kBiased) history.front().anew = true;
  const ErrorParameters parameters = Tune(problem, history, from);
  const double log_likelihood =
      ScoreHistory(problem.tape, problem.receiver, parameters, history)
          .log_likelihood;
  ErrorRegimes out;
  out.kind = kind;
  out.criterion = Criterion(problem, kind, log_likelihood);
  out.histories.push_back(
      {std::move(history), log_likelihood, 1.0, parameters});
  return out;
}

/// Of inliers and outliers together.
double MeanScale(const ErrorParameters& p) {
  const double ratio = p.outlier_ratio * p.outlier_ratio;
  return p.scale * std::sqrt(1.0 + p.outlier_share * (ratio - 1.0));
}

/// Fits the parameters to a history, and refines it by them.
ErrorRegimes FitSwitching(const RegimeProblem& problem,
                          const ErrorHistory& history,
                          const ErrorParameters& from) {
  ErrorRegimes out;
  out.kind = ErrorRegimes::Kind::kSwitching;
  out.histories = RefineHistories(problem.tape, problem.receiver,
                                  Tune(problem, history, from), {{history}});
  out.criterion =
      Criterion(problem, out.kind, out.histories.front().log_posterior);
  return out;
}

/// Climbs from an attempt; `all` may be nearer to the end of the climb than
/// what a wider search finds.
ErrorRegimes FitAttempt(const RegimeProblem& problem, const Attempt& attempt,
                        const std::vector<Attempt>& all) {
  if (problem.poll) problem.poll();
  std::vector<ScoredHistory> from =
      SearchHistories(problem.tape, problem.receiver, attempt.parameters);
  for (const Attempt& other : all) from.push_back({other.history});
  return FitSwitching(
      problem,
      ClimbHistories(problem.tape, problem.receiver, attempt.parameters, from),
      attempt.parameters);
}

/// The best history that tells another story than the best of any of `fits`,
/// or nullptr: where it was met the parameters are those of its rival.
const ScoredHistory* NextRival(const std::vector<ErrorRegimes>& fits) {
  constexpr double kLeastLog = 8.0;
  std::vector<std::vector<ErrorMode>> told;
  double least = -std::numeric_limits<double>::infinity();
  for (const ErrorRegimes& fit : fits) {
    told.push_back(StoryOf(fit.histories.front().history));
    least = std::max(least, fit.histories.front().log_posterior - kLeastLog);
  }
  const ScoredHistory* rival = nullptr;
  for (const ErrorRegimes& fit : fits) {
    for (const ScoredHistory& one : fit.histories) {
      if (one.log_posterior <= least) break;
      if (std::find(told.begin(), told.end(), StoryOf(one.history)) !=
          told.end()) {
        continue;
      }
      rival = &one;
      least = one.log_posterior;
    }
  }
  return rival;
}

/// Every story by parameters of its own.
std::vector<ErrorRegimes> FitStories(const RegimeProblem& problem,
                                     const ErrorParameters& start) {
  constexpr int kMostRivals = 2;
  const std::vector<Attempt> attempts = MakeAttempts(problem, start);
  std::vector<ErrorRegimes> fits;
  for (const Attempt& attempt : BestAttempts(problem, attempts)) {
    fits.push_back(FitAttempt(problem, attempt, attempts));
  }
  for (int i = 0; i < kMostRivals; ++i) {
    const ScoredHistory* rival = NextRival(fits);
    if (rival == nullptr) break;
    fits.push_back(FitSwitching(problem, rival->history, rival->parameters));
  }
  return fits;
}

/// The kind of the largest criterion. Beside a switching one the histories of
/// the others, but for Gauss-Markov errors, go on as alternatives.
ErrorRegimes Best(std::vector<ErrorRegimes> all) {
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return a.criterion > b.criterion;
  });
  ErrorRegimes best = std::move(all.front());
  if (best.kind != ErrorRegimes::Kind::kSwitching) return best;
  const double level = best.histories.front().log_posterior - best.criterion;
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (all[i].kind == ErrorRegimes::Kind::kGaussMarkov) continue;
    const double own =
        all[i].histories.front().log_posterior - all[i].criterion;
    for (ScoredHistory& h : all[i].histories) {
      const double log_posterior = h.log_posterior - own + level;
      const auto known =
          std::find_if(best.histories.begin(), best.histories.end(),
                       [&](const auto& b) { return b.history == h.history; });
      h.log_posterior = log_posterior;
      if (known == best.histories.end()) {
        best.histories.push_back(std::move(h));
      } else if (known->log_posterior < log_posterior) {
        *known = std::move(h);
      }
    }
  }
  std::stable_sort(best.histories.begin(), best.histories.end(),
                   [](const auto& a, const auto& b) {
                     return a.log_posterior > b.log_posterior;
                   });
  return best;
}

}  // namespace

const char* RegimeName(ErrorRegimes::Kind kind) {
  static const char* const kNames[] = {"white", "gauss_markov", "switching"};
  return kNames[static_cast<int>(kind)];
}

ErrorRegimes ChooseRegimes(const RegimeProblem& problem) {
  std::vector<ErrorRegimes> all = {
      FitUniform(problem, ErrorRegimes::Kind::kWhite, {})};
  if (!problem.only_white) {
    ErrorParameters start = all[0].histories.front().parameters;
    start.sigma = problem.stated_sigma;
    start.tau = 100.0;
    all.push_back(FitUniform(problem, ErrorRegimes::Kind::kGaussMarkov, start));
    start.scale =
        std::min(start.scale, MeanScale(all[1].histories.front().parameters));
    std::vector<ErrorRegimes> fits = FitStories(problem, start);
    std::move(fits.begin(), fits.end(), std::back_inserter(all));
  }
  return Best(std::move(all));
}

}  // namespace hindsight
