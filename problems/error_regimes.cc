#include "problems/error_regimes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "filters/history_refinement.h"
#include "filters/history_smoother.h"
#include "problems/error_tuning.h"
#include "problems/history_attempts.h"

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
                                                                    : 7;
  return log_posterior -
         0.5 * parameters * std::log(std::max(2, FixCount(problem)));
}

/// White or Gauss-Markov throughout: there is but one history.
ErrorRegimes FitUniform(const RegimeProblem& problem, ErrorRegimes::Kind kind,
                        ErrorParameters from) {
  const ErrorMode mode = kind == ErrorRegimes::Kind::kWhite
                             ? ErrorMode::kGood
                             : ErrorMode::kBiased;
  ErrorRegimes out;
  out.kind = kind;
  ErrorHistory history = Uniform(problem, mode);
  if (mode == ErrorMode::kBiased) history.front().anew = true;
  out.parameters = Tune(problem, history, from);
  const double log_likelihood =
      ScoreHistory(problem.tape, problem.receiver, out.parameters, history)
          .log_likelihood;
  out.criterion = Criterion(problem, kind, log_likelihood);
  out.histories.push_back({std::move(history), log_likelihood});
  return out;
}

/// Of inliers and outliers together.
double MeanScale(const ErrorParameters& p) {
  const double ratio = p.outlier_ratio * p.outlier_ratio;
  return p.scale * std::sqrt(1.0 + p.outlier_share * (ratio - 1.0));
}

/// Climbs from an attempt; `all` may be nearer to the end of the climb than
/// what a wider search finds.
ErrorRegimes FitSwitching(const RegimeProblem& problem, const Attempt& attempt,
                          const std::vector<Attempt>& all) {
  const LinearTape& tape = problem.tape;
  const int receiver = problem.receiver;
  if (problem.poll) problem.poll();
  ErrorRegimes out;
  out.kind = ErrorRegimes::Kind::kSwitching;
  out.parameters = attempt.parameters;
  std::vector<ScoredHistory> from =
      SearchHistories(tape, receiver, out.parameters);
  for (const Attempt& other : all) from.push_back({other.history});
  const ErrorHistory best =
      ClimbHistories(tape, receiver, out.parameters, from);
  out.parameters = Tune(problem, best, out.parameters);
  out.histories = RefineHistories(tape, receiver, out.parameters, {{best}});
  out.criterion =
      Criterion(problem, out.kind, out.histories.front().log_posterior);
  return out;
}

/// Fits the best history that tells another story than any of `fits`: where it
/// was met the parameters are those of its rival.
std::optional<ErrorRegimes> FitNextRival(
    const RegimeProblem& problem, const std::vector<ErrorRegimes>& fits) {
  constexpr double kLeastLog = 8.0;
  std::vector<std::vector<ErrorMode>> told;
  double best = -std::numeric_limits<double>::infinity();
  for (const ErrorRegimes& fit : fits) {
    told.push_back(StoryOf(fit.best()));
    best = std::max(best, fit.histories.front().log_posterior);
  }
  const ScoredHistory* rival = nullptr;
  const ErrorRegimes* from = nullptr;
  double least = best - kLeastLog;
  for (const ErrorRegimes& fit : fits) {
    for (const ScoredHistory& one : fit.histories) {
      if (one.log_posterior <= least) break;
      if (std::find(told.begin(), told.end(), StoryOf(one.history)) !=
          told.end()) {
        continue;
      }
      rival = &one;
      from = &fit;
      least = one.log_posterior;
    }
  }
  if (rival == nullptr) return std::nullopt;
  ErrorRegimes out;
  out.kind = ErrorRegimes::Kind::kSwitching;
  out.parameters = Tune(problem, rival->history, from->parameters);
  out.histories =
      RefineHistories(problem.tape, problem.receiver, out.parameters, {*rival});
  out.criterion =
      Criterion(problem, out.kind, out.histories.front().log_posterior);
  return out;
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
      if (known != best.histories.end()) {
        known->log_posterior = std::max(known->log_posterior, log_posterior);
        continue;
      }
      best.histories.push_back({std::move(h.history), log_posterior, h.count});
    }
  }
  std::stable_sort(best.histories.begin(), best.histories.end(),
                   [](const auto& a, const auto& b) {
                     return a.log_posterior > b.log_posterior;
                   });
  return best;
}

}  // namespace

bool ErrorRegimes::Has(ErrorMode mode) const {
  return std::any_of(best().begin(), best().end(),
                     [&](const ErrorStep& s) { return s.mode == mode; });
}

const char* RegimeName(ErrorRegimes::Kind kind) {
  static const char* const kNames[] = {"white", "gauss_markov", "switching"};
  return kNames[static_cast<int>(kind)];
}

ErrorRegimes ChooseRegimes(const RegimeProblem& problem) {
  std::vector<ErrorRegimes> all = {
      FitUniform(problem, ErrorRegimes::Kind::kWhite, {})};
  ErrorParameters start = all[0].parameters;
  if (!problem.only_white) {
    start.sigma = problem.stated_sigma;
    start.tau = 100.0;
    all.push_back(FitUniform(problem, ErrorRegimes::Kind::kGaussMarkov, start));
    start.scale = std::min(start.scale, MeanScale(all[1].parameters));
    const std::vector<Attempt> attempts = MakeAttempts(problem, start);
    std::vector<ErrorRegimes> fits;
    for (const Attempt& attempt : BestAttempts(problem, attempts)) {
      fits.push_back(FitSwitching(problem, attempt, attempts));
    }
    constexpr int kMostRivals = 2;
    for (int i = 0; i < kMostRivals && !fits.empty(); ++i) {
      std::optional<ErrorRegimes> rival = FitNextRival(problem, fits);
      if (!rival) break;
      fits.push_back(std::move(*rival));
    }
    std::move(fits.begin(), fits.end(), std::back_inserter(all));
  }
  return Best(std::move(all));
}

}  // namespace hindsight
