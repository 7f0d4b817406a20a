#include "receiver_errors/error_tuning.h"

#include <limits>
#include <vector>

#include "receiver_errors/parameter_tuning.h"

namespace hindsight {

ErrorParameters TuneParameters(const SensorTape& tape,
                               const ModeSequence& sequence,
                               const ErrorParameters& from,
                               SearchEffort* effort) {
  return ParameterTuning(tape, sequence, from, effort).Climb();
}

ErrorParameters TuneNoise(const SensorTape& tape, const ModeSequence& sequence,
                          const ErrorParameters& from, double least_scale,
                          SearchEffort* effort) {
  return ParameterTuning(tape, sequence, from, effort)
      .ClimbOfNoise(least_scale);
}

double LogPriorOf(const ModeSequence& sequence, const ErrorParameters& p,
                  const ErrorParameters& typical) {
  return LogPriorOf(TunablesOf(sequence, typical), p);
}

double LogShareOfPrior(const SensorTape& tape, const ModeSequence& sequence,
                       const ErrorParameters& found,
                       const ErrorParameters& typical, double least_scale,
                       SearchEffort* effort) {
  return ParameterTuning(tape, sequence, typical, effort)
      .LogShareOfPrior(found, least_scale);
}

double MostOfLogShare(const ModeSequence& sequence,
                      const ErrorParameters& typical, double least_scale) {
  std::vector<Tunable> tunables = TunablesOf(sequence, typical);
  tunables.front().least = least_scale;
  double sum = 0.0;
  for (const Tunable& tunable : tunables) sum -= LogOfPriorWithin(tunable);
  return sum;
}

std::vector<BoundedValue> BoundedParameters(const ModeSequence& sequence,
                                            const ErrorParameters& found,
                                            bool any_least_scale) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::vector<BoundedValue> values;
  for (const Tunable& t : TunablesOf(sequence, found)) {
    if (t.name == nullptr) continue;
    const bool any_below =
        t.member == &ErrorParameters::outlier_share ||
        t.member == &ErrorParameters::imu_scale ||
        (any_least_scale && t.member == &ErrorParameters::scale);
    values.push_back({.name = t.name,
                      .unit = t.unit,
                      .value = found.*t.member,
                      .least = any_below ? -kNone : t.least,
                      .most = t.most});
  }
  return values;
}

}  // namespace hindsight
