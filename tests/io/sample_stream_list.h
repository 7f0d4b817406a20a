#ifndef HINDSIGHT_TESTS_IO_SAMPLE_STREAM_LIST_H_
#define HINDSIGHT_TESTS_IO_SAMPLE_STREAM_LIST_H_

#include <cstdio>
#include <string>
#include <vector>

#include "io/recording_folder.h"
#include "io/sample_streams.h"

namespace hindsight {

inline const std::vector<std::string>& RateTitles() {
  static const std::vector<std::string> kTitles = {
      "t[s]",           "gyro_x[rad/s]",  "gyro_y[rad/s]", "gyro_z[rad/s]",
      "accel_x[m/s^2]", "accel_y[m/s^2]", "accel_z[m/s^2]"};
  return kTitles;
}

/// The recording's IMU where another stream is damaged.
inline const SampleStream& RestingImu() {
  static const SampleStream kImu = {
      "imu", Encoding::kCsv, "imu.csv", "",
      MakeRows(RateTitles(), {.001, .002, .003, .1, .2, -9.8}, Seconds)};
  return kImu;
}

/// 30 values of a place, a velocity and readings at rest.
inline std::string OxtsEpoch() {
  return "49.0 8.4 116.4 0.01 0.02 0.5 3.0 4.0 5.0 0.1 0.2 0.1 0.2 9.8 0.1 "
         "0.2 9.8 0.01 0.02 0.03 0.01 0.02 0.03 0.05 0.02 4 11 4 4 5\n";
}

/// The configuration of the stream's recording; FILE is `file`.
inline std::string ConfigOf(const SampleStream& stream,
                            const std::string& file) {
  const std::string noise =
      "  noise: {gyro: 0.2 deg/sqrt(h), accel: 70 ug/sqrt(Hz)}\n";
  std::string text = "epoch: 2017-01-01 00:00:00 UTC\n";
  if (stream.keys.starts_with("imu:")) {
    text += stream.keys + noise;
  } else {
    text += "imu:\n  file: imu.csv\n" + noise + stream.keys;
  }
  const std::size_t at = text.find("FILE");
  return text.replace(at, 4, file);
}

/// Every kind of stream in own CSV, then every other format.
inline std::vector<SampleStream> SampleStreams() {
  std::vector<SampleStream> streams;
  const auto csv = [&](const std::string& name, const std::string& keys,
                       const std::vector<std::string>& titles,
                       const std::vector<double>& values) {
    streams.push_back({name, Encoding::kCsv, "stream.csv", keys,
                       MakeRows(titles, values, Seconds)});
  };
  const auto aiding = [&](const std::string& name, const std::string& keys,
                          const std::vector<std::string>& titles,
                          const std::vector<double>& values) {
    csv("csv_" + name, "aiding:\n  s: {file: FILE, " + keys + "}\n", titles,
        values);
  };
  csv("imu_csv_rates", "imu:\n  file: FILE\n", RateTitles(),
      {.001, .002, .003, .1, .2, -9.8});
  csv("imu_csv_increments", "imu:\n  file: FILE\n",
      {"t[s]", "dtheta_x[rad]", "dtheta_y[rad]", "dtheta_z[rad]", "dvel_x[m/s]",
       "dvel_y[m/s]", "dvel_z[m/s]"},
      {.001, .002, .003, .01, .02, -.49});
  aiding("position", "type: position",
         {"t[s]", "lat[deg]", "lon[deg]", "h[m]", "sigma_n[m]", "sigma_e[m]",
          "sigma_d[m]"},
         {48.0, 11.0, 500.0, .1, .2, .3});
  aiding("position_local",
         "type: position, frame: enu, origin: [48 deg, 11 deg, 500 m]",
         {"t[s]", "p_x[m]", "p_y[m]", "p_z[m]", "sigma_x[m]", "sigma_y[m]",
          "sigma_z[m]"},
         {10.0, 20.0, 30.0, .1, .2, .3});
  aiding("velocity", "type: velocity",
         {"t[s]", "v_n[m/s]", "v_e[m/s]", "v_d[m/s]", "sigma_v_n[m/s]",
          "sigma_v_e[m/s]", "sigma_v_d[m/s]"},
         {1.0, 2.0, 3.0, .1, .2, .3});
  aiding("height", "type: height", {"t[s]", "h[m]", "sigma_h[m]"}, {500.0, .1});
  aiding("depth", "type: depth", {"t[s]", "depth[m]", "sigma_depth[m]"},
         {50.0, .1});
  aiding("dvl_axes", "type: dvl, sigma: 0.1 m/s",
         {"t[s]", "v_x[m/s]", "v_y[m/s]", "v_z[m/s]"}, {1.0, .2, .3});
  aiding("dvl_beams", "type: dvl, form: beams, sigma: 0.1 m/s",
         {"t[s]", "beam_1[m/s]", "beam_2[m/s]", "beam_3[m/s]", "beam_4[m/s]"},
         {1.0, .2, .3, .4});
  aiding("acoustic",
         "type: acoustic, sigma: 1 m, bearing_sigma: 1 deg, "
         "transponder: [48 deg, 11 deg, -50 m]",
         {"t[s]", "range[m]", "azimuth[deg]", "depression[deg]"},
         {100.0, 20.0, 30.0});
  aiding("speed_course",
         "type: speed_course, sigma: 0.1 m/s, course_sigma: 1 deg",
         {"t[s]", "speed[m/s]", "course[deg]"}, {5.0, 20.0});
  aiding("odometer", "type: odometer, form: forward, sigma: 0.1 m/s",
         {"t[s]", "speed[m/s]"}, {5.0});
  aiding("odometer_increments", "type: odometer, form: increments, sigma: 1 cm",
         {"t[s]", "distance[m]"}, {5.0});
  aiding("magnetometer", "type: magnetometer, sigma: 1 uT",
         {"t[s]", "mag_x[uT]", "mag_y[uT]", "mag_z[uT]"}, {20.0, 1.0, 40.0});
  aiding("heading",
         "type: heading, sigma: 1 deg, pitch_sigma: 1 deg, baseline: [0, 1, 0 "
         "m]",
         {"t[s]", "heading[deg]", "pitch[deg]"}, {20.0, 3.0});
  aiding("zero_velocity", "type: zero_velocity, sigma: 1 cm/s",
         {"t[s]", "zero_velocity[1]"}, {1.0});
  for (auto& row : streams.back().table.rows) row[1] = "1";
  // At rest there is no clock to be found, once the stream has been read.
  aiding("velocity_unknown_clock",
         "type: velocity, sigma: 0.1 m/s, time_offset: unknown",
         {"t[s]", "v_n[m/s]", "v_e[m/s]", "v_d[m/s]"}, {0.0, 0.0, 0.0});
  streams.back().error = "s.time_offset: is not found";
  csv("csv_truth", "truth: {file: FILE}\n",
      {"t[s]", "lat[deg]", "lon[deg]", "h[m]", "v_n[m/s]", "v_e[m/s]",
       "v_d[m/s]", "roll[deg]", "pitch[deg]", "heading[deg]"},
      {48.0, 11.0, 500.0, 1.0, 2.0, 3.0, 1.0, 2.0, 90.0});

  const auto add = [&](const std::string& name, Encoding encoding,
                       const std::string& file, const std::string& keys,
                       const TextRows& table, char delimiter = ',') {
    streams.push_back({name, encoding, file, keys, table, delimiter});
  };
  const std::string position = "aiding:\n  s: {type: position, file: FILE, ";
  const std::vector<double> rest = {.001, .002, .003, .1, .2, -9.8};
  const auto rows = [](const std::vector<double>& values,
                       const std::function<std::string(double)>& time) {
    std::vector<std::string> titles(values.size() + 1, "");
    return MakeRows(titles, values, time);
  };
  add("plain_columns_imu", Encoding::kPlain, "imu.dat",
      "imu:\n  file: FILE\n  format: columns\n  delimiter: semicolon\n"
      "  columns: {t: '1 [s]', gyro_x: '2 [rad/s]', gyro_y: '3 [rad/s]', "
      "gyro_z: '4 [rad/s]', accel_x: '5 [m/s^2]', accel_y: '6 [m/s^2]', "
      "accel_z: '7 [m/s^2]'}\n",
      rows(rest, Seconds), ';');
  add("plain_kf_gins_imu", Encoding::kPlain, "imu.txt",
      "imu:\n  file: FILE\n  format: kf_gins\n",
      rows({.001, .002, .003, .01, .02, -.49}, Seconds), ' ');
  add("plain_kf_gins_position", Encoding::kPlain, "gnss.txt",
      position + "format: kf_gins}\n",
      rows({48.0, 11.0, 500.0, .1, .2, .3}, Seconds), ' ');
  add("plain_control_points", Encoding::kPlain, "points.txt",
      position + "format: control_points}\n",
      rows({48.0, 11.0, 500.0, .1}, Seconds), ' ');
  add("plain_euroc_imu", Encoding::kPlain, "data.csv",
      "imu:\n  file: FILE\n  format: euroc\n",
      rows(rest, [](double t) { return UnixTicks(t, 1000000000); }));
  add("plain_nclt_imu", Encoding::kPlain, "ms25.csv",
      "imu:\n  file: FILE\n  format: nclt\n",
      rows({.1, .2, .3, .1, .2, -9.8, .001, .002, .003},
           [](double t) { return UnixTicks(t, 1000000); }));
  streams.back().value_column = 4;
  add("pos_position", Encoding::kPos, "rover.pos",
      position + "format: rtklib_pos}\n",
      MakeRows({"", "", "", "", "", "", "", ""},
               {48.0, 11.0, 500.0, 1.0, .1, .2, .3}, [](double t) {
                 return "2017/01/01 00:00:" + Printed(18.0 + t, 3);
               }));
  const auto clock = [](double t) { return "00000" + Printed(t, 3); };
  add("nmea_position", Encoding::kNmea, "log.nmea",
      position + "format: nmea, sigma: 2 m}\n",
      MakeRows({"", "lat", "lon", "h"}, {4800.0, 1100.0, 500.0}, clock));
  add("nmea_speed_course", Encoding::kNmea, "log.nmea",
      "aiding:\n  s: {type: speed_course, file: FILE, format: nmea, sigma: 0.1 "
      "m/s, course_sigma: 1 deg}\n",
      MakeRows({"", "speed", "course"}, {5.0, 20.0}, clock));
  add("gpx", Encoding::kGpx, "track.gpx",
      position + "format: gpx, sigma: 2 m}\n",
      MakeRows({"", "lat", "lon", "ele"}, {48.0, 11.0, 500.0}, [](double t) {
        return "2017-01-01T00:00:0" + Printed(t, 3) + "Z";
      }));
  const auto date = [](double t) {
    return "2017-01-01 00:00:0" + Printed(t, 9);
  };
  for (const char* file : {"oxts/timestamps.txt", "oxts/data/0000000020.txt"}) {
    add(std::string("oxts_") + (file[5] == 't' ? "stamps" : "epoch"),
        Encoding::kOxts, file, "imu:\n  file: oxts #FILE\n  format: oxts\n",
        MakeRows({""}, {}, date));
  }
  const std::string numbered =
      "columns: {t: 'D1 [s]', gyro_x: 'D2 [rad/s]', gyro_y: 'D3 [rad/s]', "
      "gyro_z: 'D4 [rad/s]', accel_x: 'D5 [m/s^2]', accel_y: 'D6 [m/s^2]', "
      "accel_z: 'D7 [m/s^2]'}\n";
  const auto columns = [&](const std::string& array) {
    std::string text = numbered;
    for (std::size_t at; (at = text.find("'D")) != std::string::npos;) {
      text.replace(at, 2, "'" + array);
    }
    return text;
  };
  add("npy_imu", Encoding::kNpy, "imu.npy",
      "imu:\n  file: FILE\n  format: npy\n  " + columns(""),
      rows(rest, Seconds));
  add("mat_imu", Encoding::kMat, "imu.mat",
      "imu:\n  file: FILE\n  format: mat\n  " + columns("data:"),
      rows(rest, Seconds));
  add("bag_imu", Encoding::kBag, "imu.bag",
      "imu:\n  file: FILE\n  format: rosbag\n",
      rows(rest, [](double t) { return Printed(1483228800.0 + t, 6); }));
  return streams;
}

}  // namespace hindsight

#endif  // HINDSIGHT_TESTS_IO_SAMPLE_STREAM_LIST_H_
