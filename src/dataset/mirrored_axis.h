#ifndef HINDSIGHT_DATASET_MIRRORED_AXIS_H_
#define HINDSIGHT_DATASET_MIRRORED_AXIS_H_

#include <limits>
#include <optional>
#include <string>

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

/// An IMU whose axes are left-handed, or whose gyros have the other sign; misfits
/// as ClockCandidate::misfit, infinite where it fits at no offset.
struct OtherHand {
  std::string stream;    ///< whose motion says so
  double as_read = 0.0;  ///< misfit as the IMU is read
  double mirrored = std::numeric_limits<double>::infinity();  ///< one axis of
                                                              ///< both triads
  double reversed = 0.0;  ///< all gyros turned round
};

/// By the first of the positions and velocities that fit an IMU so turned round
/// clearly better than as it is read: by three sevenths, and five standard
/// deviations of what chance makes of misfits (IsPlausible), at offsets within 10 s
/// of the clock's. Nothing once one fits
/// as it is read. Which axis is mirrored those in axes of the Earth do not tell:
/// with one of the others the attitude is half a turn apart.
std::optional<OtherHand> FindOtherHand(const Dataset& dataset);

/// What was found and which keys to correct, in words.
std::string Describe(const OtherHand& found);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_MIRRORED_AXIS_H_
