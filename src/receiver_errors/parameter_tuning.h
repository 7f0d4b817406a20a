#ifndef HINDSIGHT_RECEIVER_ERRORS_PARAMETER_TUNING_H_
#define HINDSIGHT_RECEIVER_ERRORS_PARAMETER_TUNING_H_

#include <vector>

#include "receiver_errors/mode_sequence.h"
#include "receiver_errors/search_effort.h"
#include "receiver_errors/sensor_tape.h"
#include "receiver_errors/tunable_parameters.h"

namespace hindsight {

/// The posterior of the parameters of a sequence: the likelihood of its fixes (ScoreSequence)
/// times their prior, sought parameter by parameter in the logarithm.
class ParameterTuning {
 public:
  /// Tape, sequence and effort, which may be null, must outlive this.
  ParameterTuning(const SensorTape& tape, const ModeSequence& sequence,
                  const ErrorParameters& from, SearchEffort* effort)
      : tape_(tape),
        sequence_(sequence),
        tunables_(TunablesOf(sequence, from)),
        parameters_(Bounded(tunables_, from)),
        effort_(effort) {}

  /// Multiplies each parameter by smaller and smaller steps while it gains.
  ErrorParameters Climb();
  /// The first three, scale and outliers, alone.
  ErrorParameters ClimbOfNoise(double least_scale);
  /// One alone, from `p` on; `parameters` and `value` are of where it ends.
  void ClimbAlone(double ErrorParameters::*member, const ErrorParameters& p);

  const ErrorParameters& parameters() const { return parameters_; }
  /// ln of the posterior there.
  double value() const { return value_; }
  /// ln of the posterior.
  double Value(const ErrorParameters& p) const;
  bool IsSpent() const { return effort_ != nullptr && effort_->IsSpent(); }

  /// ln of the integral of the posterior over the logarithms of the parameters, each by
  /// itself, by its value at `found`, less that of the prior.
  double LogShareOfPrior(const ErrorParameters& found, double least_scale);
  /// The same of one, at `found`, where ln of the posterior is `value`: from a parabola
  /// through three points so far apart that it falls, at least as narrow as the prior,
  /// with its top there.
  double LogShareOfPrior(double ErrorParameters::*member,
                         const ErrorParameters& found, double value);
  const Tunable& TunableOf(double ErrorParameters::*member) const;

 private:
  ErrorParameters ClimbFinely();
  /// Several of Value at once.
  std::vector<double> Values(const std::vector<ErrorParameters>& all) const;
  /// With the logarithm of a parameter moved, within its bounds.
  ErrorParameters Moved(const Tunable& tunable, double by) const;
  /// What ln of the posterior gains where the logarithm of a parameter is moved.
  struct Fall {
    bool at_least = false;  ///< the parameter is at its lower bound
    double h = 0.0;         ///< so far apart are the three points
    double near = 0.0;      ///< at h
    double far = 0.0;       ///< at -h, from the lower bound at 2 h
  };
  std::vector<Fall> FallsOf(const std::vector<const Tunable*>& tunables) const;
  double SumOfLogShares(const std::vector<const Tunable*>& tunables) const;
  static double LogShareOfPrior(const Tunable& tunable, const Fall& fall);
  bool Walk(const Tunable& tunable, double step);

  const SensorTape& tape_;
  const ModeSequence& sequence_;
  std::vector<Tunable> tunables_;
  ErrorParameters parameters_;
  SearchEffort* effort_;
  double value_ = 0.0;
};

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_PARAMETER_TUNING_H_
