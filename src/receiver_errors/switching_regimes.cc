#include "receiver_errors/switching_regimes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "receiver_errors/error_tuning.h"
#include "receiver_errors/other_tellings.h"
#include "receiver_errors/search_attempts.h"
#include "receiver_errors/sequence_refinement.h"
#include "receiver_errors/sequence_smoother.h"
#include "receiver_errors/uniform_regimes.h"

namespace hindsight {
namespace {

ErrorParameters Tune(const RegimeProblem& problem, const ModeSequence& sequence,
                     const ErrorParameters& from) {
  return TuneParameters(problem.tape, sequence, from, problem.effort);
}

/// Fits the parameters to the first of some hypotheses, and refines all by them.
ErrorRegimes FitFrom(const RegimeProblem& problem,
                     const std::vector<Hypothesis>& found,
                     const ErrorParameters& from) {
  ErrorRegimes out;
  out.kind = ErrorRegimes::Kind::kSwitching;
  out.hypotheses = RefineHypotheses(problem.tape,
                                    Tune(problem, found.front().sequence, from),
                                    found, problem.effort);
  out.log_evidence = LogEvidenceOf(problem, out.hypotheses.front(), from);
  return out;
}

ErrorRegimes FitFrom(const RegimeProblem& problem, const ModeSequence& sequence,
                     const ErrorParameters& from) {
  return FitFrom(problem, std::vector<Hypothesis>{{sequence}}, from);
}

/// Climbs from an attempt; `all` may be nearer to the end of the climb than
/// what a wider search finds.
ErrorRegimes FitAttempt(const RegimeProblem& problem, const Attempt& attempt,
                        const std::vector<Attempt>& all) {
  constexpr std::size_t kWide = 3;
  std::vector<Hypothesis> from = {{attempt.sequence}};
  if (!problem.effort->IsSpent()) {
    from = SearchHypotheses(problem.tape, attempt.parameters, kWide,
                            problem.effort);
  }
  for (const Attempt& other : all) from.push_back({other.sequence});
  return FitFrom(
      problem,
      ClimbSequences(problem.tape, attempt.parameters, from, problem.effort),
      attempt.parameters);
}

/// The best hypothesis with another order of modes than the best of any of
/// `fits`, or nullptr: where it was met the parameters are those of its rival.
const Hypothesis* NextRival(const std::vector<ErrorRegimes>& fits) {
  constexpr double kLeastLog = 8.0;
  std::vector<std::vector<ErrorMode>> known;
  double least = -std::numeric_limits<double>::infinity();
  for (const ErrorRegimes& fit : fits) {
    known.push_back(ModeOrder(fit.hypotheses.front().sequence));
    least = std::max(least, fit.hypotheses.front().log_posterior - kLeastLog);
  }
  const Hypothesis* rival = nullptr;
  for (const ErrorRegimes& fit : fits) {
    for (const Hypothesis& one : fit.hypotheses) {
      if (one.log_posterior <= least) break;
      if (std::find(known.begin(), known.end(), ModeOrder(one.sequence)) !=
          known.end()) {
        continue;
      }
      rival = &one;
      least = one.log_posterior;
    }
  }
  return rival;
}

const ErrorRegimes& Likeliest(const std::vector<ErrorRegimes>& fits) {
  return *std::ranges::max_element(fits, {}, &ErrorRegimes::log_evidence);
}

/// What else a jump may be that the likeliest fit takes for one to or from a bias:
/// the good and the erroneous stretches exchanged, by errors as large as its own;
/// or the end of a drift.
std::vector<ErrorRegimes> FitOtherTellings(
    const RegimeProblem& problem, const std::vector<ErrorRegimes>& fits) {
  std::vector<ErrorRegimes> out;
  if (fits.empty()) return out;
  const Hypothesis& likeliest = Likeliest(fits).hypotheses.front();
  for (const Attempt& other : ExchangedRoles(problem, likeliest)) {
    if (problem.effort->IsSpent()) return out;
    out.push_back(FitFrom(problem, other.sequence, other.parameters));
  }
  if (problem.effort->IsSpent()) return out;
  const Attempt drift = BestDriftThatEnds(problem, likeliest);
  if (drift.sequence.empty()) return out;
  out.push_back(FitFrom(problem, drift.sequence, drift.parameters));
  return out;
}

/// The likeliest fit from the other kind of outliers: few of them far off and more
/// that are hardly any are two maxima, and what a climb takes for steps of the
/// velocity or for errors hangs on which it began at.
std::optional<ErrorRegimes> FitOtherOutliers(
    const RegimeProblem& problem, const std::vector<ErrorRegimes>& fits) {
  constexpr double kNear = 3.0;
  constexpr double kFar = 30.0;
  if (fits.empty() || problem.effort->IsSpent()) return std::nullopt;
  const Hypothesis& likeliest = Likeliest(fits).hypotheses.front();
  ErrorParameters other = likeliest.parameters;
  const bool far = other.outlier_ratio * other.outlier_ratio > kNear * kFar;
  other.outlier_ratio = far ? kNear : kFar;
  return FitFrom(problem, likeliest.sequence, other);
}

/// From what is likeliest of all that other searches have met, which is fitted about this
/// trajectory by a third of the effort, and from what was about as likely there: effort
/// for finding that anew there may not be. None if the search was stopped.
std::optional<ErrorRegimes> FitMet(const RegimeProblem& problem) {
  constexpr double kShare = 1.0 / 3.0;
  if (problem.effort->stopped()) return std::nullopt;
  const MetHypotheses* likeliest = nullptr;
  double most = -std::numeric_limits<double>::infinity();
  for (const MetHypotheses& fit : problem.met) {
    const Hypothesis& one = fit.front();
    if (one.sequence.size() != problem.tape.fix_count()) continue;
    const double log_posterior =
        ScoreSequence(problem.tape, one.parameters, one.sequence)
            .log_posterior();
    problem.effort->Spend(problem.tape.size());
    if (log_posterior <= most) continue;
    most = log_posterior;
    likeliest = &fit;
  }
  if (likeliest == nullptr) return std::nullopt;
  SearchEffort part(kShare * problem.effort->left(), [&problem](double) {
    problem.effort->Spend(0);
    return !problem.effort->stopped();
  });
  RegimeProblem of_part = problem;
  of_part.effort = &part;
  ErrorRegimes fit =
      FitFrom(of_part, *likeliest, likeliest->front().parameters);
  problem.effort->Spend(static_cast<std::size_t>(part.spent()));
  return fit;
}

}  // namespace

std::vector<ErrorRegimes> FitSwitching(const RegimeProblem& problem,
                                       const ErrorParameters& start,
                                       const ErrorRegimes& white) {
  constexpr int kMostRivals = 2;
  const std::vector<Attempt> attempts = Hopeful(
      MakeAttempts(problem, start), white.hypotheses.front().log_posterior);
  std::vector<ErrorRegimes> fits;
  if (auto met = FitMet(problem)) fits.push_back(*std::move(met));
  for (const Attempt& attempt : BestAttempts(problem, attempts)) {
    if (!fits.empty() && problem.effort->IsSpent()) break;
    fits.push_back(FitAttempt(problem, attempt, attempts));
  }
  std::vector<ErrorRegimes> others = FitOtherTellings(problem, fits);
  std::move(others.begin(), others.end(), std::back_inserter(fits));
  if (auto other = FitOtherOutliers(problem, fits)) {
    fits.push_back(*std::move(other));
  }
  for (int i = 0; i < kMostRivals && !problem.effort->IsSpent(); ++i) {
    const Hypothesis* rival = NextRival(fits);
    if (rival == nullptr) break;
    fits.push_back(FitFrom(problem, rival->sequence, rival->parameters));
  }
  if (problem.effort->IsSpent()) return fits;
  const Attempt right =
      BestOutlierThatIsRight(problem, white.hypotheses.front());
  if (!right.sequence.empty()) {
    fits.push_back(FitFrom(problem, right.sequence, right.parameters));
  }
  return fits;
}

}  // namespace hindsight
