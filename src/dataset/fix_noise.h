#ifndef HINDSIGHT_DATASET_FIX_NOISE_H_
#define HINDSIGHT_DATASET_FIX_NOISE_H_

#include <optional>

#include "dataset/dataset.h"

namespace hindsight {

/// At most so much white noise an axis is in a stream of positions, by what they
/// show [m]: motion and slow errors count where they are not told from it. The
/// lesser of two:
///   third differences of fixes at even steps, of which white noise of variance
///   s^2 makes 20 s^2 and motion the change of its acceleration, by the median
///   of each axis
///   what is left of their second differences (6 s^2) against those of the
///   IMU's specific force, by the best rotation in each piece of 5 s
/// Nothing of fewer than 20 such differences. Errors that last, as those of a
/// receiver on its own, are not in it.
std::optional<double> NoiseOfFixes(const ImuStream& imu,
                                   const InitialState& initial,
                                   const AidingStream& stream);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_FIX_NOISE_H_
