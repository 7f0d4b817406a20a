#include "problems/error_regimes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "filters/history_refinement.h"
#include "filters/history_smoother.h"
#include "problems/error_tuning.h"

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
  return TuneParameters(problem.tape, problem.receiver, history, from);
}

double Criterion(const RegimeProblem& problem, ErrorRegimes::Kind kind,
                 double log_posterior) {
  const int parameters = kind == ErrorRegimes::Kind::kWhite         ? 3
                         : kind == ErrorRegimes::Kind::kGaussMarkov ? 5
                                                                    : 6;
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

bool IsGood(const ErrorHistory& history) {
  return std::all_of(history.begin(), history.end(), [](const ErrorStep& s) {
    return s.mode == ErrorMode::kGood;
  });
}

/// Where the search for histories begins: errors of several sizes, short or
/// lasting.
std::vector<ErrorParameters> Starts(const RegimeProblem& problem,
                                    const ErrorParameters& white) {
  constexpr double kRateTime = 100.0;
  std::vector<ErrorParameters> starts;
  for (const auto& [size, tau] : {std::pair{5.0, 1e8},
                                  {5.0, 30.0},
                                  {50.0, 1e8},
                                  {50.0, 30.0},
                                  {500.0, 1e8}}) {
    ErrorParameters& p = starts.emplace_back(white);
    p.sigma = size * problem.stated_sigma;
    p.tau = tau;
    p.rate_sigma = p.sigma / kRateTime;
  }
  return starts;
}

struct Attempt {
  ErrorParameters parameters;
  ScoredHistory found;
};

/// The most promising starts by a narrow search.
std::vector<Attempt> BestAttempts(const RegimeProblem& problem,
                                  const ErrorParameters& white) {
  constexpr std::size_t kNarrow = 1;
  constexpr std::size_t kMost = 2;
  constexpr double kLeastLog = 15.0;
  std::vector<Attempt> attempts;
  for (const ErrorParameters& start : Starts(problem, white)) {
    attempts.push_back(
        {start, SearchHistories(problem.tape, problem.receiver, start, kNarrow)
                    .front()});
  }
  std::sort(attempts.begin(), attempts.end(), [](const auto& a, const auto& b) {
    return a.found.log_posterior > b.found.log_posterior;
  });
  const double least = attempts.front().found.log_posterior - kLeastLog;
  std::vector<Attempt> best;
  for (Attempt& attempt : attempts) {
    if (best.size() == kMost || attempt.found.log_posterior < least) break;
    if (IsGood(attempt.found.history)) continue;
    if (!best.empty() && best.back().found.history == attempt.found.history) {
      continue;
    }
    best.push_back(std::move(attempt));
  }
  return best;
}

/// Of inliers and outliers together.
double MeanScale(const ErrorParameters& p) {
  const double ratio = p.outlier_ratio * p.outlier_ratio;
  return p.scale * std::sqrt(1.0 + p.outlier_share * (ratio - 1.0));
}

/// The same with the noise that goes with the best of them: to a fit of white
/// errors biases look like noise and outliers.
std::vector<Attempt> AttemptsWithNoise(const RegimeProblem& problem,
                                       ErrorParameters start) {
  std::vector<Attempt> attempts = BestAttempts(problem, start);
  if (attempts.empty()) return attempts;
  const ErrorParameters tuned =
      Tune(problem, attempts[0].found.history, attempts[0].parameters);
  const auto near = [](double a, double b, double factor) {
    return a < factor * b && b < factor * a;
  };
  if (near(tuned.scale, start.scale, 1.1) &&
      near(tuned.outlier_share, start.outlier_share, 3.0)) {
    return attempts;
  }
  start.scale = tuned.scale;
  start.outlier_share = tuned.outlier_share;
  start.outlier_ratio = tuned.outlier_ratio;
  return BestAttempts(problem, start);
}

ErrorRegimes FitSwitching(const RegimeProblem& problem,
                          const Attempt& attempt) {
  const auto& [tape, receiver, stated, only_white] = problem;
  ErrorRegimes out;
  out.kind = ErrorRegimes::Kind::kSwitching;
  out.parameters = attempt.parameters;
  for (int i = 0; i < 2; ++i) {
    out.histories = SearchHistories(tape, receiver, out.parameters);
    out.parameters = Tune(problem, out.best(), out.parameters);
  }
  out.histories =
      RefineHistories(tape, receiver, out.parameters, out.histories);
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
      const bool known =
          std::any_of(best.histories.begin(), best.histories.end(),
                      [&](const auto& b) { return b.history == h.history; });
      if (known) continue;
      best.histories.push_back(
          {std::move(h.history), h.log_posterior - own + level, h.count});
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
    for (const Attempt& attempt : AttemptsWithNoise(problem, start)) {
      all.push_back(FitSwitching(problem, attempt));
    }
  }
  return Best(std::move(all));
}

}  // namespace hindsight
