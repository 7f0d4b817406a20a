#ifndef HINDSIGHT_DATASET_MIRRORED_AXIS_H_
#define HINDSIGHT_DATASET_MIRRORED_AXIS_H_

#include <optional>

#include "dataset/dataset.h"

namespace hindsight {

/// Which axis of an IMU has the wrong sign.
struct MirroredAxis {
  int axis = 0;         ///< 0 to 2: of both triads; 3: the sign of all gyros
  double misfit = 0.0;  ///< ClockCandidate::misfit with it turned round
  double next_misfit = 0.0;  ///< of the next best of the four
};

/// For an IMU in which gravity turns against the gyros: the axis that, turned
/// round, fits the velocities in the vehicle's axes (DVL, odometer) best by
/// SearchClock. Nothing if another is not clearly worse, by three sevenths of
/// its misfit.
std::optional<MirroredAxis> FindMirroredAxis(const Dataset& dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_MIRRORED_AXIS_H_
