#ifndef HINDSIGHT_IO_SCENARIO_CONFIG_H_
#define HINDSIGHT_IO_SCENARIO_CONFIG_H_

#include <filesystem>
#include <string>
#include <vector>

#include "simulation/scenario.h"

namespace hindsight {

/// \file
/// Scenarios as YAML. Every physical value carries its unit; an unknown key is
/// an error. Keys without default are needed unless marked optional.
///
/// | key                  | meaning                                | default |
/// |----------------------|----------------------------------------|---------|
/// | name                 | of the data set                        | file name
/// | | description          | one line                               | empty |
/// | start.position       | [lat, lon, h]                          |         |
/// | start.heading        |                                        | 0 deg   |
/// | start.speed          |                                        | 0 m/s   |
/// | segments             | list, below; instead of it:            |         |
/// | wander.duration, wander.seed | a drawn route of a car         | seed 1  |
/// | profile              | file of a motion, instead of start and segments | |
/// | duration             | the simulation ends here               | of the
/// motion | | imu.kind             | increments, rates                      |
/// increments | | imu.rate             | | 200 Hz  | | imu.noise            |
/// as in a data set (io/config.h)         |         | | imu.gyro_bias,
/// imu.accel_bias | fixed part of the start bias  | 0       | |
/// imu.gyro_bias_sigma, imu.accel_bias_sigma | of its drawn part | 0       | |
/// imu.gyro_scale, imu.accel_scale | scale errors                | 0 ppm   | |
/// aiding.NAME          | type, rate 1 Hz, sigma, lever_arm, time_offset, gate
/// as in a data set; from, to, outages: list of {from, to} | | | truth_rate |
/// | 10 Hz   | | start_errors         | optional: position, velocity, attitude
/// sigmas of the initial values, which are left out without it | | |
/// stationary, withhold, nodes.max_spacing | as in a data set    |         |
///
/// Types are position, velocity, height, dvl and acoustic, the latter two with
/// the keys they have in a data set; dvl besides: beam_dropout, the probability
/// that a ping loses a beam (0), and true_current (NED, 0 m/s). `estimate` as
/// in a data set; the errors of scale, mounting, lever arm and offset are drawn
/// from its sigmas.
///
/// A segment is a map with its kind in `type`:
///   {type: straight, duration}
///   {type: stop, duration, deceleration 2 m/s^2}
///   {type: accelerate, speed, rate}
///   {type: turn, angle, rate, banked false}   right is positive
///   {type: pitch, angle, rate}                up is positive
/// each with `blend`, the time in which its rate rises and falls (1 s).

/// Reads a scenario file. Throws InputError "file:line: ...".
Scenario LoadScenario(const std::string& path);

/// The files that LoadScenario reads: itself and its profile. Throws alike.
std::vector<std::filesystem::path> ScenarioFiles(const std::string& path);

/// A built-in scenario if `name_or_path` is the name of one, else the file.
Scenario FindScenario(const std::string& name_or_path);

/// A motion profile: own CSV with the columns of truth (io/csv_format.h), or
/// text without header, t [s], lat, lon [deg], h [m], v_n, v_e, v_d [m/s],
/// roll, pitch, heading [deg], comma-separated; plain or gzip. Throws
/// InputError naming file and line.
std::vector<ProfilePoint> ReadMotionProfile(const std::string& path);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_SCENARIO_CONFIG_H_
