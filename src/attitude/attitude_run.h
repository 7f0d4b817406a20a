#ifndef HINDSIGHT_ATTITUDE_ATTITUDE_RUN_H_
#define HINDSIGHT_ATTITUDE_ATTITUDE_RUN_H_

#include <functional>
#include <span>
#include <vector>

#include "attitude/attitude_filter.h"
#include "filters/linear_tape.h"
#include "imu/imu_stream.h"

namespace hindsight {

/// A sample's state, with the covariance and the verdict of the last update.
struct AttitudeEpoch {
  AttitudeState x;
  AttitudeVerdict verdict;
};

struct AttitudeRun {
  std::vector<AttitudeEpoch> epochs;  ///< one a sample
};

/// Runs the filter over a record of rates, with an update at the first and the
/// last sample and every update_interval in between; each magnetic sample is
/// used at the first IMU sample that is not earlier, turned there by the gyros.
/// `tape`, if not null, receives every update for the RTS smoother. `poll` is
/// called now and then with the samples done, and may throw. Throws
/// EstimationError if the filter diverges.
AttitudeRun RunAttitudeFilter(
    const ImuStream& imu, std::span<const MagneticSample> magnetic,
    const AttitudeFilterOptions& options, const AttitudeState& start,
    LinearTape* tape = nullptr,
    const std::function<void(std::size_t)>& poll = nullptr);

}  // namespace hindsight

#endif  // HINDSIGHT_ATTITUDE_ATTITUDE_RUN_H_
