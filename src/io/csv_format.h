#ifndef HINDSIGHT_IO_CSV_FORMAT_H_
#define HINDSIGHT_IO_CSV_FORMAT_H_

/// \file
/// The project's own CSV (`format: csv`), which `simulate` writes and every
/// reader accepts, plain or gzip.
///
/// Lines that start with '#' and empty lines are comments. The first other
/// line names the columns as `name[unit]`, separated by commas; every further
/// line holds one row. Columns are found by name, so their order is free, and
/// columns that a reader does not know are left alone. Units are converted:
/// any unit of the right dimension will do (io/units.h).
///
/// | stream              | columns                                            |
/// |---------------------|----------------------------------------------------|
/// | imu, rates          | t, gyro_x, gyro_y, gyro_z, accel_x, accel_y,       |
/// |                     | accel_z                                            |
/// | imu, increments     | t, dtheta_x, dtheta_y, dtheta_z, dvel_x, dvel_y,   |
/// |                     | dvel_z                                             |
/// | position            | t, lat, lon, h, sigma_n, sigma_e, sigma_d          |
/// | velocity            | t, v_n, v_e, v_d, sigma_v_n, sigma_v_e, sigma_v_d  |
/// | height              | t, h, sigma_h                                      |
/// | depth               | t, depth, sigma_depth                              |
/// | odometer            | t, speed or, of increments, distance; side, down   |
/// | dvl, three axes     | t, v_x, v_y, v_z                                   |
/// | dvl, beams          | t, beam_1 ... beam_4 and, if known, valid_1 ...    |
/// |                     | valid_4 (0 is lost; so is a speed that is absent)  |
/// | acoustic            | t and what `sigma` and `bearing_sigma` are given   |
/// |                     | for: range; azimuth, depression                    |
/// | truth               | t and any of {lat, lon, h}, {v_n, v_e, v_d},       |
/// |                     | {roll, pitch, heading}                             |
///
/// In the units the writers use:
///   t[s],gyro_x[rad/s],...,accel_x[m/s^2],...
///   t[s],dtheta_x[rad],...,dvel_x[m/s],...
///   t[s],lat[deg],lon[deg],h[m],sigma_n[m],sigma_e[m],sigma_d[m]
///   t[s],v_n[m/s],v_e[m/s],v_d[m/s],sigma_v_n[m/s],sigma_v_e[m/s],...
///   t[s],h[m],sigma_h[m]
///   t[s],lat[deg],lon[deg],h[m],v_n[m/s],v_e[m/s],v_d[m/s],roll[deg],...
///
/// IMU axes are sensor axes until `axes` and `mounting` of the configuration
/// turn them; specific force is -g upwards at rest (body z negative).
/// Increments belong to the interval that ends at the stamp unless the
/// configuration says `stamp: start`; every row is used, so that the IMU begins
/// one interval before the first row's end. t is seconds since the data set's
/// epoch unless the stream's `time` says otherwise. A position and a velocity
/// stream may name the same file. In position and height streams an optional
/// column `quality` holds an integer that `accept_quality` selects by. A dvl's
/// column `water` is 1 where it tracks the water and 0 where the bottom.

#endif  // HINDSIGHT_IO_CSV_FORMAT_H_
