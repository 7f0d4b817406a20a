#ifndef HINDSIGHT_IO_CONFIG_H_
#define HINDSIGHT_IO_CONFIG_H_

#include <string>
#include <vector>

#include "dataset/dataset.h"

namespace hindsight {

/// \file
/// The configuration of a recording: one YAML file. Every physical value
/// carries its unit (io/units.h). A key that is not in this list is an error.
/// "-" marks a key without default; such a key may be left out unless it is
/// marked *needed*.
///
/// | key                      | meaning                           | default |
/// |--------------------------|-----------------------------------|---------|
/// | name                     | of the recording                  | file name |
/// | folder                   | of the files: relative to the configuration, or
/// to the data root | . | | epoch                    | date and time at t = 0,
/// "yyyy-mm-dd hh:mm:ss GPST" or "UTC" | whole second before the first IMU
/// sample, if that is dated | | imu                      | *needed*, see below
/// |         | | aiding.NAME              | one aiding stream each, see below |
/// | | initial                  | see below                         |         |
/// | stationary               | `off`, or its thresholds          | off     |
/// | truth                    | a stream, see below               | -       |
/// | withhold                 | list of {sensor, every, length, from} | none |
/// | nodes.max_spacing        | longest interval between states   | 1 s     |
///
/// Every stream (imu, aiding.NAME, truth):
/// | file                     | *needed*; plain or gzip           |         |
/// | format                   | csv, columns, kf_gins, rtklib_pos | csv     |
/// | columns                  | for `columns`: QUANTITY: COLUMN [UNIT], where
/// COLUMN is a number from 1 or a title and a leading "-" turns the sign; or
/// {column, unit, scale} | | | delimiter                | auto, comma,
/// semicolon, blank     | auto    | | skip_lines               | lines before
/// the header or data   | 0       | | time.clock               | dataset, gps,
/// unix: what stamps count from | dataset | | time.week                | stamps
/// are seconds of this GPS week | -     | | time.start               | first
/// row is at this date or time; the rest follows | - | | time.duration | last
/// row is this much later; stamps in between are stretched | - | | time.rate |
/// stamps are row number / rate      | -       | | on_duplicate             |
/// error, drop_first, drop_last      | error   | | allow_truncated_tail     |
/// drop a last line that was cut off | false   |
///
/// imu besides:
/// | kind                     | rates, increments                 | as the
/// columns say | | axes                     | body x, y, z in sensor axes,
/// "[-x, y, -z]" | [x, y, z] | | mounting                 | roll, pitch, yaw of
/// a rotation after `axes`: body = Rz(yaw) Ry(pitch) Rx(roll) axes(sensor) | 0
/// | | stamp                    | end or start of an increment's interval | end
/// | | time_offset              | added to the stamps               | 0 s     |
/// | max_gap                  | longer intervals are errors       | 0.5 s   |
/// | noise.gyro, noise.accel  | *needed* noise densities          |         |
/// | noise.gyro_bias_walk, noise.accel_bias_walk | densities      | 0       |
/// | noise.gyro_bias_sigma with noise.gyro_bias_tau | a Gauss-Markov bias
/// instead of a walk; accel likewise | - | | noise.gyro_per_rate      | noise
/// density per rad/s           | 0       |
///
/// aiding.NAME besides:
/// | type                     | *needed*: position, velocity, height |      |
/// | lever_arm                | from the IMU, body axes           | 0       |
/// | time_offset              | true time = stamp + offset        | 0 s     |
/// | sigma                    | replaces the file's: one or NED   | -       |
/// | sigma_scale              | multiplies the file's             | 1       |
/// | correlations             | use the file's covariances        | true    |
/// | accept_quality           | list of values of the column quality that are
/// used | all | | gate                     | probability that a good
/// measurement passes, or off | off | | estimate.lever_arm,
/// estimate.time_offset | a priori sigma of an estimated one | - |
///
/// truth besides: lever_arm (of the point it speaks of), time_offset,
/// absent_values (empty and NaN values are absent; default false).
///
/// initial: time, position [lat, lon, h], velocity (NED), attitude (roll,
/// pitch, heading), heading, gyro_bias, accel_bias, and position_sigma,
/// velocity_sigma, attitude_sigma, gyro_bias_sigma, accel_bias_sigma. What is
/// absent is found by alignment.
///
/// withhold: outage k starts at first fix + from + k every and lasts length;
/// from is every if it is absent. The first fix is the first that the IMU
/// covers.
///
/// stationary: window 1 s, gyro_threshold 0.01 rad/s, accel_threshold
/// 0.1 m/s^2, velocity_sigma 0.01 m/s, rate_sigma 5e-4 rad/s.

struct LoadOptions {
  /// Where folders are looked for that are not beside the configuration.
  std::string data_root = "../shared/data";
};

/// Everything a load used, in SI units, defaults included; itself a
/// configuration that loads the same data set.
struct ResolvedConfig {
  std::string yaml;
};

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
