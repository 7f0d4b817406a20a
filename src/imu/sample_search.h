#ifndef HINDSIGHT_IMU_SAMPLE_SEARCH_H_
#define HINDSIGHT_IMU_SAMPLE_SEARCH_H_

#include <cstddef>

#include "imu/imu_stream.h"

namespace hindsight {

/// The first sample at or after t, as many as there are if there is none. Sought
/// from where regular stamps would have it: bisection of a whole day would take
/// all over the recording into memory.
std::size_t FirstSampleAt(const ImuStream& imu, double t);

/// The first sample after t, likewise.
std::size_t FirstSampleAfter(const ImuStream& imu, double t);

}  // namespace hindsight

#endif  // HINDSIGHT_IMU_SAMPLE_SEARCH_H_
