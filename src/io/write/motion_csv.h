#ifndef HINDSIGHT_IO_WRITE_MOTION_CSV_H_
#define HINDSIGHT_IO_WRITE_MOTION_CSV_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "imu/kinematics.h"

namespace hindsight {

/// What the IMU read, biases and scale factors removed, at its own place and in
/// body axes, as means about the stamps (MeanMotion): t[s], w_x[deg/s] to
/// w_z[deg/s] against inertial space, f_x[m/s^2] to f_z[m/s^2] specific force.
/// `program` and what t = 0 is go into the comments. Throws OutputError if the
/// file cannot be written.
void WriteMotionCsv(const std::string& path, const std::vector<double>& t,
                    const std::vector<Kinematics>& motion,
                    const std::string& program,
                    std::optional<std::int64_t> epoch_gps_ns);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_MOTION_CSV_H_
