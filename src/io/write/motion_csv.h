#ifndef HINDSIGHT_IO_WRITE_MOTION_CSV_H_
#define HINDSIGHT_IO_WRITE_MOTION_CSV_H_

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "imu/kinematics.h"
#include "io/read/solution_columns.h"

namespace hindsight {

/// \file
/// METHOD.motion.csv: what the IMU read, biases and scale factors removed, at
/// its own place and in body axes, as means about the stamps (MeanReadings):
/// t[s], w_x[deg/s] to w_z[deg/s] against inertial space, f_x[m/s^2] to
/// f_z[m/s^2] specific force.

/// t and MotionColumns().
std::vector<SolutionColumn> MotionFileColumns();

/// A row a time, in the units of these columns.
Eigen::MatrixXd MotionRows(std::span<const double> t,
                           std::span<const Kinematics> motion);

/// The comment lines, with `program` and what t = 0 is.
std::string MotionComments(const std::string& program,
                           std::optional<std::int64_t> epoch_gps_ns);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_MOTION_CSV_H_
