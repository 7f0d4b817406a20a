#ifndef HINDSIGHT_DATASET_STAMP_CHECK_H_
#define HINDSIGHT_DATASET_STAMP_CHECK_H_

#include <string>
#include <vector>

#include "dataset/checks.h"
#include "imu/imu_stream.h"

namespace hindsight {

/// Scatter of a stream's intervals beyond this part of the median one is told.
inline constexpr double kMaxJitter = 0.2;

/// What the stamps of a stream say, in time order [s].
StreamReport ReportStamps(const std::string& name,
                          const std::vector<double>& stamps,
                          const ImuStream& imu);

/// The same of the IMU's rows: the first sample of increments is none.
StreamReport ReportImuStamps(const ImuStream& imu);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_STAMP_CHECK_H_
