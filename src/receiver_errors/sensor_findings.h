#ifndef HINDSIGHT_RECEIVER_ERRORS_SENSOR_FINDINGS_H_
#define HINDSIGHT_RECEIVER_ERRORS_SENSOR_FINDINGS_H_

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "receiver_errors/error_states.h"
#include "receiver_errors/normal_points.h"
#include "receiver_errors/receiver_errors.h"
#include "receiver_errors/regime_choice.h"
#include "receiver_errors/search_effort.h"
#include "receiver_errors/sensor_tape.h"
#include "receiver_errors/weighed_hypotheses.h"

namespace hindsight {

/// How long a search may take.
struct SearchLimits {
  double share = 1.0;        ///< of the effort that a search may cost
  SearchEffort::GoOn go_on;  ///< of all steps
};

/// What a search decided about one sensor: sequences by fix, wherever nodes
/// stand.
struct ErrorDecisions {
  ErrorDecisions(const Problem& problem, const LinearTape& tape, int index);
  bool stands() const { return choice.chosen > 0; }
  /// Of a sensor of metres: whether so many are more than three stated sigmas of a
  /// fix. What another sensor moves is always large.
  bool IsLarge(double metres) const {
    return unit != "m" || metres > 3.0 * stated_sigma;
  }
  bool switching() const {
    return regimes.kind == ErrorRegimes::Kind::kSwitching;
  }

  int sensor;
  std::string name;
  bool alone = false;   ///< it has positions in use, and no other sensor has
  std::string beside;   ///< it has, and of all others this one alone
  std::string unit;     ///< of its error
  double stated_sigma;  ///< of its fixes, an axis [SI]
  bool is_tolerance;    ///< as of RegimeProblem
  std::size_t searched_fixes = 0;  ///< fixes or normal points
  /// ln of the evidence that was chosen, on these, without the likelihood.
  double log_prior = 0.0;
  RegimeChoice choice;
  /// ln of the evidence of what stands over that of the noise as stated, on all of the
  /// tape: each sensor is searched on a tape of its own, and what RegimeChoice::gain says
  /// of one compares with no other's.
  double gain = 0.0;
  /// RegimeChoice::undecided, by fix; their log_posterior is the gain.
  std::vector<Hypothesis> undecided;
  /// RegimeChoice::open, or what was refused after it.
  std::optional<OpenBias> open;
  /// The likeliest noise, by fix, against which these were weighed.
  Hypothesis likeliest_noise;
  ErrorRegimes regimes;  ///< if they stand
  /// Of each fit of switching errors, whether they stand or not, by fix or normal point as
  /// they were searched.
  std::vector<MetHypotheses> met;
  bool stopped = false;   ///< the search, by whoever asked
  bool unfitted = false;  ///< it was, before any parameters were fitted
};

/// What is known of the errors of one sensor once they have been looked for.
struct SensorFindings : ErrorDecisions {
  SensorFindings(const Problem& problem, const LinearTape& linear, int index,
                 const SearchLimits& limits,
                 std::vector<MetHypotheses> before = {});
  /// Decided before, about another tape.
  SensorFindings(const ErrorDecisions& decisions, const LinearTape& linear);
  const WeighedHypothesis& chosen() const { return alternatives[central]; }
  ErrorStates states() const {
    return {tape, sensor, stated_sigma, unit, regimes.kind, chosen()};
  }
  std::vector<double> Times() const;
  double Duration() const { return tape.t(tape.size() - 1) - tape.t(0); }
  /// What may be beside noise, with its probability.
  std::vector<WeighedHypothesis> SmoothUndecided() const;
  /// The noise against which what is undecided was weighed.
  WeighedHypothesis SmoothNoise() const;
  WeighedHypothesis Smooth(const ErrorParameters& parameters,
                           const ModeSequence& sequence) const;
  /// What was found on normal points, at all fixes, on a tape that holds them.
  void Refine(const SensorTape& fixes, const NormalPoints& points,
              std::vector<ErrorRegimes> found, SearchEffort* effort);
  /// The noise of all fixes, where normal points show no errors: outliers among
  /// fixes are not in them.
  void ChooseNoise(const SensorTape& fixes, SearchEffort* effort);

  /// ErrorDecisions::gain of what stands; of all these `whole` is of `tape`.
  double GainOn(const SensorTape& whole) const;
  /// What speaks against it on all measurements: a parameter at a bound of its search, or a
  /// gain of less than RegimeChoice asks; "" if nothing does. The least factor on a stated
  /// sigma is no such bound here: fixes that follow each other faster than their errors
  /// change scatter by as little as they like.
  std::string ObjectionOn(const SensorTape& whole, bool has_clock) const;
  /// Says in RegimeChoice::refused why it is not; a bias throughout stays open.
  void Refuse(const SensorTape& whole, const std::string& why);

  /// Takes back what stands, but not what was refused.
  void Withdraw();

  /// Smooths the hypotheses of the regimes, which stand, about the tape.
  void WeighAlternatives(const SensorTape& whole);
  /// Where good and erroneous fixes may be the other way about, beside the chosen
  /// hypothesis the one with them exchanged.
  void AddExchanged();

  const LinearTape& tape;
  std::vector<WeighedHypothesis> alternatives;
  std::size_t central = 0;  ///< of the alternatives, the chosen one
  /// The chosen one has the sensor err from its first fix, doubtfully.
  bool errant_start = false;
  /// How probable it is that the only other sensor of positions is off throughout, and
  /// this one is not at first (ExchangedWithOther).
  double other_errs = 0.0;
  double spent = 0.0;  ///< share of the effort that the search took
};

/// What was decided, about another tape, of which nothing is searched anew;
/// nullptr if its nodes do not hold as many fixes of the sensor. `tape` must
/// outlive what is returned.
std::unique_ptr<const SensorFindings> FindingsAgain(
    const ErrorDecisions& decisions, const LinearTape& tape);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_SENSOR_FINDINGS_H_
