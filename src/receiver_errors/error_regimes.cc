#include "receiver_errors/error_regimes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "receiver_errors/error_tuning.h"
#include "receiver_errors/other_tellings.h"
#include "receiver_errors/regime_choice.h"
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

/// Of inliers and outliers together.
double MeanScale(const ErrorParameters& p) {
  const double ratio = p.outlier_ratio * p.outlier_ratio;
  return p.scale * std::sqrt(1.0 + p.outlier_share * (ratio - 1.0));
}

/// Fits the parameters to the first of some hypotheses, and refines all by them.
ErrorRegimes FitSwitching(const RegimeProblem& problem,
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

ErrorRegimes FitSwitching(const RegimeProblem& problem,
                          const ModeSequence& sequence,
                          const ErrorParameters& from) {
  return FitSwitching(problem, std::vector<Hypothesis>{{sequence}}, from);
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
  return FitSwitching(
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
    out.push_back(FitSwitching(problem, other.sequence, other.parameters));
  }
  if (problem.effort->IsSpent()) return out;
  const Attempt drift = BestDriftThatEnds(problem, likeliest);
  if (drift.sequence.empty()) return out;
  out.push_back(FitSwitching(problem, drift.sequence, drift.parameters));
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
  return FitSwitching(problem, likeliest.sequence, other);
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
      FitSwitching(of_part, *likeliest, likeliest->front().parameters);
  problem.effort->Spend(static_cast<std::size_t>(part.spent()));
  return fit;
}

/// Every order of modes by parameters of its own.
std::vector<ErrorRegimes> FitOrders(const RegimeProblem& problem,
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
    fits.push_back(FitSwitching(problem, rival->sequence, rival->parameters));
  }
  if (problem.effort->IsSpent()) return fits;
  const Attempt right =
      BestOutlierThatIsRight(problem, white.hypotheses.front());
  if (!right.sequence.empty()) {
    fits.push_back(FitSwitching(problem, right.sequence, right.parameters));
  }
  return fits;
}

/// Beside an error throughout, white noise that takes it for outliers is a maximum of its
/// own. Where white noise, `all`'s second, is far likelier than as stated, its first, the
/// error is fitted from the noise a priori as well; the likelier one counts.
void FitGaussMarkovAnew(const RegimeProblem& problem,
                        const ErrorParameters& start,
                        const std::vector<ErrorRegimes>& all,
                        ErrorRegimes* gauss_markov) {
  if (all[1].log_evidence < all[0].log_evidence + kLeastGain) return;
  ErrorParameters typical;
  typical.sigma = start.sigma;
  typical.tau = start.tau;
  ErrorRegimes other =
      FitGaussMarkov(problem, typical, gauss_markov->log_evidence);
  if (other.log_evidence > gauss_markov->log_evidence) {
    if (!other.slight) other.slight = gauss_markov->slight;
    *gauss_markov = std::move(other);
  }
}

/// The noise of all fixes, in turn with the change points to which it is fitted: those
/// of normal points are up to a second off, and what lies between looks like outliers
/// or noise.
ErrorParameters TuneAndClimb(const RegimeProblem& problem, Hypothesis* best) {
  constexpr int kMostTurns = 4;
  ErrorParameters parameters = best->parameters;
  for (int i = 0; i < kMostTurns; ++i) {
    parameters = TuneNoise(problem.tape, best->sequence, parameters,
                           kLeastScale, problem.effort);
    ModeSequence climbed = ClimbSequences(problem.tape, parameters,
                                          {{best->sequence}}, problem.effort);
    if (climbed == best->sequence) break;
    best->sequence = std::move(climbed);
  }
  return parameters;
}

}  // namespace

const char* RegimeName(ErrorRegimes::Kind kind) {
  static const char* const kNames[] = {"stated", "white", "Gauss-Markov",
                                       "switching"};
  return kNames[static_cast<int>(kind)];
}

MetHypotheses LikelyOf(const ErrorRegimes& fit) {
  constexpr std::size_t kMost = 24;
  constexpr double kLeastLog = 5.0;
  const double least = fit.hypotheses.front().log_posterior - kLeastLog;
  MetHypotheses likely;
  for (const Hypothesis& one : fit.hypotheses) {
    if (likely.size() == kMost || one.log_posterior < least) break;
    likely.push_back(one);
  }
  return likely;
}

std::vector<ErrorRegimes> FitRegimes(const RegimeProblem& problem) {
  std::vector<ErrorRegimes> all = FitNoise(problem);
  if (problem.only_white) return all;
  ErrorParameters start = all[1].hypotheses.front().parameters;
  start.sigma = problem.stated_sigma;
  start.tau = 100.0;
  if (!problem.has_gauss_markov) {
    all.push_back(FitGaussMarkov(problem, start));
  }
  if (problem.effort->stopped()) return all;
  start.scale = std::min(start.scale,
                         MeanScale(all.back().hypotheses.front().parameters));
  std::vector<ErrorRegimes> fits = FitOrders(problem, start, all[1]);
  // Last, as it is not to cost the search of sequences anything.
  if (!problem.has_gauss_markov) {
    FitGaussMarkovAnew(problem, start, all, &all.back());
  }
  std::move(fits.begin(), fits.end(), std::back_inserter(all));
  return all;
}

ErrorRegimes RefineAtFixes(const RegimeProblem& problem,
                           const NormalPoints& points,
                           const ErrorRegimes& found) {
  // What is weighed in the end is among the likeliest, which come first.
  constexpr std::size_t kLeast = 48;
  const std::size_t most =
      std::max(kLeast, kMostKeptSteps / problem.tape.fix_count());
  std::vector<Hypothesis> all;
  for (const Hypothesis& one : found.hypotheses) {
    if (all.size() == most) break;
    all.push_back(one);
    all.back().sequence = AtFixes(points, one.sequence);
  }
  const double least_scale =
      found.kind == ErrorRegimes::Kind::kWhite ? kLeastSolved : kLeastScale;
  const ErrorParameters parameters =
      found.kind == ErrorRegimes::Kind::kSwitching
          ? TuneAndClimb(problem, &all.front())
          : TuneNoise(problem.tape, all.front().sequence,
                      all.front().parameters, least_scale, problem.effort);
  ErrorRegimes out;
  out.kind = found.kind;
  out.expected = found.expected;
  out.slight = found.slight;
  if (found.kind == ErrorRegimes::Kind::kSwitching) {
    out.hypotheses =
        RefineHypotheses(problem.tape, parameters, all, problem.effort);
  } else {
    all.front().parameters = parameters;
    all.front().log_posterior =
        ScoreSequence(problem.tape, parameters, all.front().sequence)
            .log_likelihood;
    out.hypotheses = std::move(all);
  }
  out.log_evidence =
      LogEvidenceOf(problem, out.hypotheses.front(), parameters, least_scale);
  return out;
}

}  // namespace hindsight
