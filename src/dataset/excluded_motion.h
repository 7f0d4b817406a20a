#ifndef HINDSIGHT_DATASET_EXCLUDED_MOTION_H_
#define HINDSIGHT_DATASET_EXCLUDED_MOTION_H_

#include <algorithm>
#include <vector>

#include "dataset/dataset.h"
#include "dataset/speed_evidence.h"
#include "dataset/time_interval.h"

namespace hindsight {

/// What all aiding together says against motion over whole spans, however long.
/// Over a short stretch a slow motion cannot be told from rest; over a long one
/// it adds up to a distance that the aiding measures.
class ExcludedMotion {
 public:
  /// Uses every measurement that is not withheld.
  explicit ExcludedMotion(const Dataset& dataset)
      : record_(dataset),
        slack_(2.0 * dataset.stationary.velocity_sigma),
        window_(std::min(dataset.stationary.window, 1.0)) {}

  /// True if no measurement of the whole recording tells a speed or a place.
  bool empty() const;

  /// The mean speed that aiding leaves possible over `span` [m/s]: of the
  /// stream that tells most of it, on its worst axis, the root of the squares
  /// of the speed and of its standard deviation. Infinite without aiding.
  double PossibleSpeed(const TimeInterval& span) const;

  /// Cuts from `span` what aiding contradicts: the span, or any half, quarter,
  /// ... of it down to two seconds, by steps of half its length, over which a
  /// stream's mean speed is, on any axis, more than four sigmas and twice
  /// StationaryOptions::velocity_sigma, as the mean over a part of n windows
  /// has it (over sqrt(n)); before and after it, what is shorter
  /// than twice that length as well. What remains goes to `remaining`, the
  /// rest to `cut`.
  void Cut(const TimeInterval& span, std::vector<TimeInterval>* remaining,
           std::vector<TimeInterval>* cut) const;

 private:
  bool Contradicts(const TimeInterval& span) const;

  SpeedRecord record_;
  double slack_;   ///< of the mean speed over a window [m/s]
  double window_;  ///< [s]
};

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_EXCLUDED_MOTION_H_
