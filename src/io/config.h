#ifndef HINDSIGHT_IO_CONFIG_H_
#define HINDSIGHT_IO_CONFIG_H_

#include <filesystem>
#include <string>
#include <vector>

#include "dataset/dataset.h"

namespace hindsight {

// clang-format off
/// \file
/// The configuration of a recording: one YAML file. Every physical value
/// carries its unit (io/units.h). A key that is not in this list is an error.
/// "-" marks a key without default; it may be left out unless it is *needed*.
///
/// | key               | meaning                                  | default |
/// |-------------------|------------------------------------------|---------|
/// | name              | of the recording                         | file name |
/// | folder            | of the files: relative to the configuration, or to the data root | . |
/// | epoch             | date and time at t = 0, "yyyy-mm-dd hh:mm:ss GPST" or "UTC" | whole second before the first IMU sample, if that is dated |
/// | imu               | *needed*, see below                      |         |
/// | aiding.NAME       | one aiding stream each, see below; NAME of letters, digits, _ - . |         |
/// | initial           | see below                                |         |
/// | place             | [lat, lon, h] where attitude alone is estimated: gives gravity and the Earth's rate, which are 9.80665 m/s^2 and nothing without it | - |
/// | ahrs              | see below                                |         |
/// | alignment         | auto, given, static, gyrocompass, course, velocity, magnetometer, ahrs: how the attitude at the start is found | auto |
/// | stationary        | `off`, `on`, or its thresholds           | off     |
/// | truth             | a stream, see below                      | -       |
/// | withhold          | list of {sensor, every, length, from}    | none    |
/// | nodes.max_spacing | longest interval between states          | 1 s     |
///
/// Every stream (imu, aiding.NAME, truth):
/// | file              | *needed*; plain or gzip; a folder for oxts and npy |  |
/// | format            | csv, columns, kf_gins, rtklib_pos, euroc, nclt, control_points, oxts, nmea, npy, mat, rosbag | csv |
/// | columns           | of columns, npy, mat: QUANTITY: COLUMN [UNIT]. COLUMN is a number from 1 or a title, of npy and mat ARRAY or ARRAY:NUMBER (io/array_rows.h); a leading "-" turns the sign; or {column, unit, scale}. The time t has no sign, and a scale in npy and mat only | - |
/// | delimiter         | auto, comma, semicolon, blank            | auto    |
/// | skip_lines        | lines before the header or data          | 0       |
/// | topic             | of a rosbag                              | the only one that fits |
/// | time.clock        | dataset, gps, unix: what stamps count from | dataset; unix for euroc and nclt |
/// | time.week         | stamps are seconds of this GPS week, and may run over its end | - |
/// | time.week_rollovers | times 1024 weeks that dates lack       | 0       |
/// | time.start        | first row is at this date or time; the rest follows | - |
/// | time.duration     | last row is this much later; stamps in between are stretched | - |
/// | time.stretch      | factor on the time since the first row   | 1       |
/// | time.rate         | stamps are row number / rate             | -       |
/// | time.from, time.until | only rows this much behind the first are used | all |
/// | on_duplicate      | error, drop_first, drop_last             | error   |
/// | on_unordered      | error, sort                              | error   |
/// | absent_values     | empty and NaN values are absent: truth keeps the rest of the row, aiding passes over it | false |
/// | allow_truncated_tail | drop a last line that was cut off: without line end, and incomplete or with a last value shorter than any before | false   |
///
/// imu besides:
/// | kind              | rates, increments                        | as the columns say |
/// | axes              | body x, y, z in sensor axes, "[-x, y, -z]" | [x, y, z] |
/// | mounting          | roll, pitch, yaw of a rotation after `axes`: body = Rz(yaw) Ry(pitch) Rx(roll) axes(sensor) | 0 |
/// | stamp             | end or start of an increment's interval; the first row's is taken as long as the median one, with `start` the last row's too | end     |
/// | time_offset       | added to the stamps                      | 0 s     |
/// | max_gap           | longer intervals are errors; shorter drop-outs are bridged with noise to match | 0.5 s |
/// | noise.gyro, noise.accel | *needed* noise densities           |         |
/// | noise.gyro_bias_walk, noise.accel_bias_walk | densities      | 0       |
/// | noise.gyro_bias_sigma with noise.gyro_bias_tau | a Gauss-Markov bias instead of a walk; accel likewise | - |
/// | noise.gyro_per_rate | noise density per rad/s                | 0       |
/// | estimate.gyro_scale, estimate.accel_scale | a priori sigma of estimated scale factors | - |
///
/// aiding.NAME besides:
/// | type              | *needed*: position, velocity, height, depth, speed_course, odometer, non_holonomic, dvl, acoustic, magnetometer, zero_velocity | |
/// | lever_arm         | from the IMU, body axes                  | 0       |
/// | time_offset       | true time = stamp + offset; `truth`: that of the truth; `unknown`: the data tell, see below | 0 s     |
/// | every             | use one measurement in this time         | all     |
/// | sigma             | replaces the file's: one or NED; of the speed for speed_course; forward, side, down or one for odometer, of an increment for its increments; [side, down] for non_holonomic | - |
/// | sigma_scale       | multiplies the file's                    | 1       |
/// | correlations      | use the file's covariances               | true    |
/// | accept_quality    | list of values of the column quality that are used | all |
/// | gate              | probability that a good measurement passes, or off | off |
/// | loss              | {kind: huber, cauchy, tukey or geman_mcclure, scale in standard deviations} | none |
/// | noise             | {model: white}; {model: gauss_markov, sigma and tau *needed*, white: a tenth of sigma}, for position, velocity and height, in place of the file's sigma; {model: mixture, outliers: 5 %, ratio: 20}, a share of outliers of so many sigmas | white |
/// | estimate.lever_arm, estimate.time_offset | a priori sigma of an estimated one | - |
/// `time_offset: unknown` searches for the offsets, with at least half of the shorter
/// record inside the other, at which the stream's turns or accelerations fit
/// the IMU's (dataset/clock_search.h; position, velocity, height, depth,
/// speed_course, odometer, dvl and magnetometer); it is then estimated. Of
/// several, and of those within four sigmas of an estimate.time_offset of 0.1 s
/// or more, each is solved to its end, the likeliest is taken and the others are
/// told with their probability (problems/clock_choice.h).
/// speed_course: course_sigma *needed*; course_above, the speed below which a
/// course is not used, 1 m/s. odometer and non_holonomic: mounting (roll,
/// pitch, yaw: vehicle = Rz(yaw) Ry(pitch) Rx(roll) body; or `unknown`: the first
/// value comes from the data, see alignment/mounting_search.h, and 10 deg is the
/// default of) estimate.mounting; level_on_average (-), the sigma with which the
/// vehicle's mean roll over the record is zero, without which the mounting's roll
/// is not observed. odometer: form, three_axis, forward or increments; scale,
/// measured = (1 + scale) true, and estimate.scale. Its columns side and down,
/// if it has them, are measured speeds; else the vehicle moves along its x axis.
/// increments take a column `distance` that counts up; sigma [m] is of one
/// increment, independent of the others (ground, slip), count_sigma (0 m) of one
/// count, whose error the next count does not inherit (resolution/sqrt(12)).
/// non_holonomic: no file; rate *needed*.
/// magnetometer: sigma *needed*, per axis; columns mag_x, mag_y, mag_z; axes
/// and mounting as of the imu; form, heading or vector (heading); declination,
/// magnetic from true north, east positive, 0; hard_iron, field of the vehicle
/// itself in body axes, 0; horizontal, the horizontal field, 20 uT, and down, its
/// downward part, both *needed* for vector; estimate.hard_iron,
/// estimate.declination, estimate.disturbance, a Gauss-Markov field in NED axes
/// with estimate.disturbance_tau, 10 s. It has no lever arm.
///
/// zero_velocity: the IMU stands where its column zero_velocity is 1 (0 elsewhere);
/// sigma *needed*, of each axis [m/s]: how fast it may still move in a stance. Rows
/// within a second share that error (dataset/standing_flags.h). It has no lever arm.
///
/// height: estimate.offset, an additive constant. depth, besides: surface, the
/// height of the water above the ellipsoid, 0 m.
///
/// dvl (measurements/dvl.h): form, three_axis (columns v_x, v_y, v_z) or beams
/// (beam_1 to beam_4, each of which may be absent or have a 0 in valid_1 to
/// valid_4); beam_angle from the vertical, 30 deg; beam_azimuth of the first
/// beam from forward to right, 45 deg; sigma *needed*, one, or forward, right,
/// down of three_axis; mounting and scale as of an odometer; track, bottom or
/// water, for rows where a column water (1, 0) does not say; current, *needed*
/// by water track: {sigma of each component; time or length over which it is
/// correlated, else it is constant}; estimate.scale, estimate.mounting.
///
/// acoustic: range and bearing to a transponder (measurements/acoustic_fix.h):
/// transponder [lat, lon, h] *needed*; sigma of the range if it is used (column
/// range), bearing_sigma if the bearing is (azimuth, depression); mounting;
/// scale of the range; estimate.scale, estimate.mounting. The position that an
/// array on a ship gives is a position.
///
/// truth besides: lever_arm (of the point it speaks of); time_offset, or `unknown`: found from the
/// gyros (dataset/clock_search.h); axes and
/// mounting as of the imu, of the axes that its attitude speaks of; for columns
/// p_x, v_x and q_w and the like, moving (0 or 1): frame (ecef, ned, enu, nwu; ecef), origin
/// ([lat, lon, h] of local frames) and quaternion (body_to_frame,
/// frame_to_body; body_to_frame).
///
/// initial: from, given or truth (given): time, position, velocity and attitude that are absent
/// are the truth's at its first point inside the record; time, position [lat, lon, h], velocity (NED), attitude (roll,
/// pitch, heading), heading, gyro_bias, accel_bias, and position_sigma,
/// velocity_sigma, attitude_sigma, gyro_bias_sigma, accel_bias_sigma. Without a
/// time a given position, velocity or attitude is that of the first IMU sample. What is
/// absent is found by alignment.
///
/// ahrs (methods ahrs, ahrs_smoother, ahrs_batch, ahrs_tilt_batch): rule, of the accelerometer:
/// fixed, gate, held_gate, adaptive, smnc (fixed); accel_sigma 0.18 m/s^2; gate
/// 0.88 m/s^2; lambda 0.05; samples 4, N of smnc and held_gate, or seconds in its
/// place; low_pass, 1.5 s with the fixed rule and 0 s with the others;
/// correlation_time 1 s, of the errors of accelerometer and magnetometer;
/// rest_sigma 1 deg/s, of the gyro bias as read at rest; reject_disturbances
/// true, by norm and dip of the field; survey true, smoother and batch find field
/// and hard iron of the whole recording first; room 1 m and room_speed 1 m/s, what the
/// batch knows of the motion.
///
/// withhold: outage k starts at first fix + from + k every and lasts length;
/// from is every if it is absent. The first fix is the first that the IMU
/// covers.
///
/// What is asked for is bounded: 31 days of the IMU's record, 100000 outages of
/// a sensor, columns up to the 100000th, ten non_holonomic measurements for
/// each sample of the IMU, 1000000 ahrs.samples or 3600 s, 10 million nodes, 4 MB
/// of configuration.
///
/// stationary: window 1 s, gyro_threshold 0.01 rad/s, accel_threshold
/// 0.1 m/s^2, velocity_sigma 0.01 m/s, rate_sigma 5e-4 rad/s.
// clang-format on

struct LoadOptions {
  /// Where folders are looked for that are not beside the configuration.
  std::string data_root = "../shared/data";
  /// Aiding streams of the configuration that are left out, by name.
  std::vector<std::string> without = {};
};

/// Everything a load used, in SI units, defaults included; itself a
/// configuration that loads the same data set.
struct ResolvedConfig {
  std::string yaml;
};

/// The files and folders that loading the configuration reads, itself and those
/// of streams that are left out included. Throws InputError as LoadDataset does
/// for what the configuration says.
std::vector<std::filesystem::path> ConfigInputs(
    const std::string& config_path, const LoadOptions& options = {});

/// Reads a configuration and all files it names. Throws InputError, one line
/// naming file and line. `resolved` may be null.
Dataset LoadDataset(const std::string& config_path,
                    const LoadOptions& options = {},
                    ResolvedConfig* resolved = nullptr);

/// Replaces the list `withhold` by what was actually withheld.
void SetWithholdings(const std::vector<Withholding>& withholdings,
                     ResolvedConfig* resolved);

/// Writes the resolved configuration to `path`, complete or not at all.
void WriteResolvedConfig(const ResolvedConfig& resolved,
                         const std::string& path);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_H_
