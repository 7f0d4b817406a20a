#include "receiver_errors/uniform_regimes.h"

#include <limits>
#include <optional>
#include <utility>

#include "receiver_errors/bias_range.h"
#include "receiver_errors/error_tuning.h"
#include "receiver_errors/regime_choice.h"
#include "receiver_errors/sequence_refinement.h"
#include "receiver_errors/sequence_smoother.h"

namespace hindsight {
namespace {

ModeSequence Uniform(const RegimeProblem& problem, ErrorMode mode) {
  return ModeSequence(problem.tape.fix_count(), ErrorStep{mode, false});
}

/// Scale and outliers alone, as the batch would be solved with them.
ErrorParameters TuneAsSolved(const RegimeProblem& problem,
                             const ModeSequence& sequence,
                             const ErrorParameters& from) {
  return TuneNoise(problem.tape, sequence, from, kLeastSolved, problem.effort);
}

/// The noise as stated: what the plain batch takes it for.
ErrorRegimes AsStated(const RegimeProblem& problem) {
  Hypothesis one;
  one.sequence = Uniform(problem, ErrorMode::kGood);
  one.parameters.outlier_share = 0.0;
  one.log_posterior =
      ScoreSequence(problem.tape, one.parameters, one.sequence).log_likelihood;
  ErrorRegimes out;
  out.log_evidence = one.log_posterior;
  out.hypotheses.push_back(std::move(one));
  return out;
}

/// What a uniform fit is asked for.
struct UniformQuestion {
  /// With noise that the batch can be solved with.
  bool as_solved = false;
  /// Evidence that cannot exceed this is not integrated, but told as its bound [ln].
  double worth = -std::numeric_limits<double>::infinity();
};

double LeastScale(const UniformQuestion& question) {
  return question.as_solved ? kLeastSolved : kLeastScale;
}

/// `log_gain` is what a range of biases adds to it.
double LogEvidence(const RegimeProblem& problem, const Hypothesis& one,
                   const ErrorParameters& from, double log_gain,
                   const UniformQuestion& question) {
  const double bound =
      one.log_posterior + LogPriorOf(one.sequence, one.parameters, from) +
      MostOfLogShare(one.sequence, from, LeastScale(question)) + log_gain;
  if (bound <= question.worth) return bound;
  return LogEvidenceOf(problem, one, from, LeastScale(question)) + log_gain;
}

/// White or Gauss-Markov throughout: there is but one sequence of modes.
ErrorRegimes FitUniform(const RegimeProblem& problem, ErrorRegimes::Kind kind,
                        const ErrorParameters& from,
                        const UniformQuestion& question = {}) {
  const ErrorMode mode = kind == ErrorRegimes::Kind::kWhite
                             ? ErrorMode::kGood
                             : ErrorMode::kBiased;
  Hypothesis one;
  one.sequence = Uniform(problem, mode);
  if (mode == ErrorMode::kBiased) one.sequence.front().anew = true;
  const auto tune = [&](const ErrorParameters& start) {
    one.parameters =
        question.as_solved
            ? TuneAsSolved(problem, one.sequence, start)
            : TuneParameters(problem.tape, one.sequence, start, problem.effort);
  };
  tune(from);
  ModeSequence climbed =
      ClimbOutliers(problem.tape, one.parameters, one.sequence, problem.effort);
  if (climbed != one.sequence) {
    one.sequence = std::move(climbed);
    tune(one.parameters);
  }
  const auto score = [&] {
    one.log_posterior =
        ScoreSequence(problem.tape, one.parameters, one.sequence)
            .log_likelihood;
  };
  std::optional<BiasRange> range;
  if (mode == ErrorMode::kBiased) {
    range = FollowBias(problem.tape, one.sequence, one.parameters, from,
                       problem.effort);
    one.parameters = range->likeliest;
  }
  score();
  ErrorRegimes out;
  out.kind = kind;
  out.log_evidence =
      LogEvidence(problem, one, from, range ? range->log_gain : 0.0, question);
  if (range) {
    one.parameters = range->mean;
    out.expected = range->expected;
    out.slight = range->slight;
    score();
  }
  out.hypotheses.push_back(std::move(one));
  return out;
}

}  // namespace

double LogEvidenceOf(const RegimeProblem& problem, const Hypothesis& best,
                     const ErrorParameters& from, double least_scale) {
  return best.log_posterior + LogPriorOf(best.sequence, best.parameters, from) +
         LogShareOfPrior(problem.tape, best.sequence, best.parameters, from,
                         least_scale, problem.effort);
}

bool CanBeSolved(const ErrorParameters& white) {
  return white.scale >= kLeastSolved && white.imu_scale <= kMisstatedImu;
}

std::vector<ErrorRegimes> FitNoise(const RegimeProblem& problem) {
  std::vector<ErrorRegimes> all = {AsStated(problem)};
  UniformQuestion question;
  // Where nothing richer is compared with them.
  if (problem.only_white) question.worth = all[0].log_evidence + kLeastGain;
  all.push_back(FitUniform(problem, ErrorRegimes::Kind::kWhite, {}, question));
  if (!CanBeSolved(all[1].hypotheses.front().parameters)) {
    question.as_solved = true;
    all.push_back(
        FitUniform(problem, ErrorRegimes::Kind::kWhite, {}, question));
  }
  return all;
}

ErrorRegimes FitGaussMarkov(const RegimeProblem& problem,
                            const ErrorParameters& from, double worth) {
  return FitUniform(problem, ErrorRegimes::Kind::kGaussMarkov, from,
                    {.worth = worth});
}

}  // namespace hindsight
