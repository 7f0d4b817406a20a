#ifndef HINDSIGHT_DATASET_STANDSTILL_H_
#define HINDSIGHT_DATASET_STANDSTILL_H_

#include <vector>

#include "dataset/dataset.h"
#include "imu/imu_stream.h"

namespace hindsight {

struct TimeInterval {
  double begin = 0.0;
  double end = 0.0;
};

/// Spans in which the vehicle stands, from the IMU alone: every window of
/// `options.window` seconds inside has a standard deviation of the angular rate
/// and of the specific force (norm over the axes) below the thresholds, and a
/// mean specific force within 3 % of gravity. Consecutive windows are joined.
/// `options.enabled` is not looked at. Linear in the number of samples.
std::vector<TimeInterval> FindStandstill(const ImuStream& imu,
                                         const StationaryOptions& options);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_STANDSTILL_H_
