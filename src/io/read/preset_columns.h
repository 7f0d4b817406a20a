#ifndef HINDSIGHT_IO_READ_PRESET_COLUMNS_H_
#define HINDSIGHT_IO_READ_PRESET_COLUMNS_H_

#include <vector>

#include "io/read/text_format.h"

namespace hindsight {

/// The columns of text formats without a header of their own, told apart by
/// `fields`, the quantities of the stream:
///   kf_gins  imu: t dtheta(3) [rad] dvel(3) [m/s]; odometer: t and the speed
///            [m/s] in column 8 of the same file; truth: week t lat lon [deg] h
///            v_n v_e v_d roll pitch heading [deg]; position: t lat lon [deg] h
///            sigma_n sigma_e sigma_d
///   euroc    imu: t [ns] gyro(3) [rad/s] accel(3) [m/s^2]; truth: t [ns]
///            position(3) [m] quaternion w x y z, body to world, velocity(3)
///   nclt     imu (ms25.csv): t [us] field(3) accel(3) gyro(3); position,
///            height, speed and course (gps.csv): t [us] mode satellites lat
///            lon [rad] h [m] course [rad] speed [m/s], the mode as quality
///   control_points  t lat lon [deg] h sigma [m], one sigma for three axes
/// Empty if the format has no such stream.
std::vector<ColumnMapping> PresetColumns(TextFormat::Kind kind,
                                         const std::vector<FieldName>& fields);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_PRESET_COLUMNS_H_
