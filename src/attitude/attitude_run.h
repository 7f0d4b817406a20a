#ifndef HINDSIGHT_ATTITUDE_ATTITUDE_RUN_H_
#define HINDSIGHT_ATTITUDE_ATTITUDE_RUN_H_

#include <functional>
#include <vector>

#include "attitude/attitude_filter.h"
#include "attitude/attitude_state.h"
#include "imu/imu_stream.h"

namespace hindsight {

/// At a sample of the IMU: by the gyros from the update before it, or after
/// that at it.
struct AttitudeSample {
  Eigen::Quaterniond q_nb;
  Eigen::Vector3d b_g;
  std::size_t node = 0;  ///< the update
};

struct AttitudeRun {
  std::vector<AttitudeSample> samples;  ///< one a sample of the IMU
  std::vector<AttitudeNode> nodes;      ///< one an update
  std::vector<ScalarUpdate> updates;    ///< what a smoother needs of them
  std::vector<AttitudeInnovation> innovations;  ///< in order of time
};

/// Runs the filter over a record of rates, with an update at the first and the
/// last sample and every update_interval in between; each magnetic sample is
/// used at the first IMU sample that is not earlier, turned there by the gyros;
/// so is each heading, with an update there. Of the velocities those a second
/// and more apart are used, at their own times, with an update at the IMU's
/// sample, and the accelerometer is used by them alone: a vehicle whose
/// velocity is told is not one whose accelerations fall out.
/// The updates are recorded if the run is to be smoothed. `poll` is called now
/// and then with the samples done, and may throw. Throws EstimationError if the
/// filter diverges.
AttitudeRun RunAttitudeFilter(
    const ImuStream& imu, const AttitudeReadings& readings,
    const AttitudeFilterOptions& options, const AttitudeState& start,
    bool to_be_smoothed = false,
    const std::function<void(std::size_t)>& poll = nullptr);

}  // namespace hindsight

#endif  // HINDSIGHT_ATTITUDE_ATTITUDE_RUN_H_
