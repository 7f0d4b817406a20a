#ifndef HINDSIGHT_DATASET_REST_DEPARTURE_H_
#define HINDSIGHT_DATASET_REST_DEPARTURE_H_

#include <cstddef>
#include <span>

#include "dataset/excluded_motion.h"
#include "dataset/imu_cells.h"
#include "imu/imu_stream.h"

namespace hindsight {

/// Sigma of the speed gathered in `tau` [s] by readings of white noise and bias
/// walk less their mean over the `T` [s] before [m/s].
double GatheredSigma(const ImuNoise& noise, double tau, double T);

/// How many cells at the end of a rest (`step` +1), or at its begin (-1), are
/// none: the shorter part, where the mean specific force differs most from that
/// of the longer so that it brings more than kKnownSpeed and four sigmas, unless
/// aiding excludes the way it would make. Zero if there are none, or where
/// anything shakes the IMU.
std::size_t DepartedCells(std::span<const ImuCell> rest, int step,
                          const ImuNoise& noise, const ExcludedMotion& aiding);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_REST_DEPARTURE_H_
