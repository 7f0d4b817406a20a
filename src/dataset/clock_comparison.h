#ifndef HINDSIGHT_DATASET_CLOCK_COMPARISON_H_
#define HINDSIGHT_DATASET_CLOCK_COMPARISON_H_

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dataset/dataset.h"

namespace hindsight {

/// How well the motion in another record agrees with the IMU's, as a function
/// of the offset that is added to the stamps of that record.
struct ClockComparison {
  /// As ClockCandidate::misfit; infinite where too little overlaps.
  std::function<double(double offset)> misfit;
  double first = 0.0;  ///< stamps it covers [s]
  double last = 0.0;
  double resolution = 0.0;  ///< length of the windows compared [s]
  double freedom = 0.0;     ///< independent components of them all
  std::string compared;     ///< in words
};

/// Length of the windows compared [s].
inline constexpr double kShortestClockWindow = 0.5;
inline constexpr double kLongestClockWindow = 5.0;

/// Nothing for a type that is not compared, or too few measurements.
std::optional<ClockComparison> CompareStream(const ImuStream& imu,
                                             const InitialState& initial,
                                             const AidingStream& stream);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_CLOCK_COMPARISON_H_
