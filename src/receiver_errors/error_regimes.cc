#include "receiver_errors/error_regimes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "receiver_errors/error_tuning.h"
#include "receiver_errors/regime_choice.h"
#include "receiver_errors/sequence_refinement.h"
#include "receiver_errors/sequence_smoother.h"
#include "receiver_errors/switching_regimes.h"
#include "receiver_errors/uniform_regimes.h"

namespace hindsight {
namespace {

/// Of inliers and outliers together.
double MeanScale(const ErrorParameters& p) {
  const double ratio = p.outlier_ratio * p.outlier_ratio;
  return p.scale * std::sqrt(1.0 + p.outlier_share * (ratio - 1.0));
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
  std::vector<ErrorRegimes> fits = FitSwitching(problem, start, all[1]);
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
