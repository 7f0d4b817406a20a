#ifndef HINDSIGHT_DATASET_WHEEL_SPEED_H_
#define HINDSIGHT_DATASET_WHEEL_SPEED_H_

#include <optional>

#include "dataset/dataset.h"

namespace hindsight {

/// How a wheel's speed compares with that over the ground.
struct WheelComparison {
  double factor = 0.0;  ///< ground over wheel; negative: it counts backward
  double offset = 0.0;  ///< true time = stamp + offset [s]
  double correlation = 0.0;  ///< of the two at that offset
};

/// Regresses the ground speed (GroundVelocities) on the wheel's, as read in the
/// direction in which it mostly turns, at offsets of up to 20 s; the best is
/// taken. Nothing if they correlate by less than 0.9.
std::optional<WheelComparison> FindWheel(const AidingStream& wheel,
                                         const Dataset& dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_WHEEL_SPEED_H_
