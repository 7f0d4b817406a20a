#ifndef HINDSIGHT_EVALUATION_CONTRADICTED_SENSOR_H_
#define HINDSIGHT_EVALUATION_CONTRADICTED_SENSOR_H_

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/grade.h"

namespace hindsight {

/// What the a priori values of start and constants are called among sensors.
inline constexpr const char* kPriorValues = "the a priori values";

/// What leaving out one sensor at a time says of data that do not fit.
struct LeftOutSensor {
  /// Sensors without any one of which the others fit each other, kPriorValues
  /// among them. One: it is what the others contradict. Several: they contradict
  /// each other.
  std::vector<std::string> sensors;
  /// Of all together, the largest figure of fit over its limit.
  double misfit = 0.0;
  std::optional<double> onset;  ///< since when; none: throughout [s]
  /// By what the solution without the sensor, if it is one, differs from that
  /// with it: root mean square over the interval of the component of position,
  /// velocity or attitude with most, in the solution's sigmas.
  double effect = std::numeric_limits<double>::infinity();
};

/// Whether a sensor, or the prior, is the one that all others contradict, and the
/// solution is within kUnusableBias of what these alone say: what does not fit of
/// the sensor is then no reason not to use the solution.
bool IsOutvoted(const Judged& judged, const std::string& sensor);

/// Doubtful, beside the evidence of what does not fit: which sensor it is.
void FindContradictedSensor(const Judged& judged,
                            std::vector<Evidence>* evidence);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_CONTRADICTED_SENSOR_H_
