#ifndef HINDSIGHT_MEASUREMENTS_STANDING_FLAGS_H_
#define HINDSIGHT_MEASUREMENTS_STANDING_FLAGS_H_

#include "measurements/measurement.h"

namespace hindsight {

/// How long the error of a flag of standing goes on: what still moves during a
/// stance, a shoe that rolls or a vehicle that rocks, is one motion, and the
/// next row of the recording says nothing new of it [s].
inline constexpr double kStanceError = 1.0;

/// Gives zero velocities in time order, flagged row by row, the sigmas of
/// measurements of independent errors that say as much: with n of them within
/// half of kStanceError on either side,
///   sigma = sqrt(n) * sigma of one.
/// A stance of up to half a second then counts as one measurement, a long one
/// as one a second, whatever the rate of the rows; rows a second apart are left
/// as they are. Other models are not touched.
void ShareErrorsOfStances(MeasurementSeries* measurements);

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_STANDING_FLAGS_H_
