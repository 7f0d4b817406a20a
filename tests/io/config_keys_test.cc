#include "fuzz/config_keys.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "io/config/config_help.h"
#include "io/config/scenario_config.h"
#include "io/recording_folder.h"
#include "io/sample_stream_list.h"

namespace hindsight {
namespace {

using Keys = std::set<std::string>;

/// The fuzzer of configurations knows every key that a configuration can have:
/// what an unknown key's error lists.
class ConfigKeys : public RecordingFolder {
 protected:
  static constexpr const char* kUnknown = "zzzzzzzzzzzzzzzzzzzz: 1";

  void SetUp() override {
    Write("imu.csv", Encode(RestingImu(), RestingImu().table));
  }

  /// The keys that are asked for where `rest` holds an unknown one. `imu` are
  /// further keys of the imu.
  Keys Asked(const std::string& rest, const std::string& imu = "",
             const std::string& noise = "") const {
    Write("config.yaml",
          "imu:\n  file: imu.csv\n  noise: {gyro: 0.2 deg/sqrt(h), accel: 70 "
          "ug/sqrt(Hz)" +
              noise + "}\n" + imu + rest);
    const std::vector<std::string> keys = Expected(LoadError());
    return {keys.begin(), keys.end()};
  }
  Keys AskedOfSensor(const std::string& keys) const {
    return Asked("aiding:\n  s:\n    file: imu.csv\n    " + keys + "\n    " +
                 kUnknown + "\n");
  }

  static Keys Known(const std::vector<std::string>& maps,
                    const std::vector<FuzzMap>& all = RecordingMaps()) {
    Keys keys;
    for (const FuzzMap& map : all) {
      if (std::find(maps.begin(), maps.end(), map.name) == maps.end()) continue;
      for (const FuzzKey& key : map.keys) keys.emplace(key.key);
    }
    return keys;
  }
};

TEST_F(ConfigKeys, OfTheRecordingAndItsStreams) {
  const std::string unknown = std::string("{") + kUnknown + "}\n";
  EXPECT_EQ(Asked(std::string(kUnknown) + "\n"), Known({"top"}));
  EXPECT_EQ(Asked("", std::string("  ") + kUnknown +
                          "\n  format: columns\n  columns: {t: '1 [s]'}\n"),
            [] {
              Keys keys = Known({"stream", "imu"});
              keys.erase("topic");
              return keys;
            }());
  EXPECT_TRUE(Asked("", std::string("  format: rosbag\n  ") + kUnknown + "\n")
                  .contains("topic"));
  EXPECT_EQ(Asked("", "  time: " + unknown), Known({"time"}));
  EXPECT_EQ(Asked("", "",
                  ", gyro_bias_walk: 0 deg/h/sqrt(h), "
                  "accel_bias_tau: 1 h, accel_bias_sigma: 1 mg, " +
                      std::string(kUnknown)),
            Known({"imu_noise"}));
  for (const std::string map : {"initial", "ahrs", "stationary", "nodes"}) {
    Keys known = Known({map});
    // One stands in the other's place.
    if (map == "ahrs") known.erase("samples"), known.erase("seconds");
    Keys asked = Asked(map + ": " + unknown);
    asked.erase("samples"), asked.erase("seconds");
    EXPECT_EQ(asked, known) << map;
  }
  EXPECT_EQ(
      Asked("constants: {from: imu.csv, " + std::string(kUnknown) + "}\n"),
      Known({"constants"}));
  EXPECT_EQ(Asked("withhold: [{sensor: s, every: 2 s, length: 1 s, " +
                  std::string(kUnknown) + "}]\n"),
            Known({"withhold"}));
  Keys truth = Asked("truth:\n  file: imu.csv\n  " + std::string(kUnknown) +
                     "\n  format: columns\n  columns: {t: '1 [s]'}\n");
  truth.insert("topic");
  EXPECT_EQ(truth, Known({"stream", "truth"}));
}

TEST_F(ConfigKeys, OfEveryTypeOfSensor) {
  const std::string place = "transponder: [48 deg, 11 deg, 0 m]";
  const std::string field = "horizontal: 20 uT\n    down: 40 uT";
  const std::vector<std::string> sensors = {
      "type: position",
      "type: position\n    frame: ned\n    origin: [48 deg, 11 deg, 0 m]",
      "type: position\n    frame: utm\n    zone: 32",
      "type: velocity",
      "type: height",
      "type: depth",
      "type: acoustic\n    sigma: 1 m\n    bearing_sigma: 1 deg\n    " + place,
      "type: speed_course\n    sigma: 1 m/s\n    course_sigma: 1 deg",
      "type: odometer\n    sigma: 1 m/s",
      "type: odometer\n    sigma: 1 m\n    form: increments",
      "type: magnetometer\n    sigma: 1 uT\n    form: vector\n    " + field,
      "type: dvl\n    sigma: 1 m/s\n    form: beams",
      "type: zero_velocity\n    sigma: 1 cm/s",
      "type: heading\n    sigma: 1 deg"};
  // That has no file; its keys are asked for below.
  Keys types = {"non_holonomic"};
  for (const std::string& sensor : sensors) {
    types.insert(sensor.substr(6, sensor.find('\n') - 6));
  }
  EXPECT_EQ(AskedOfSensor("type: zzzz"), types);
  Keys values(FuzzValues().begin(), FuzzValues().end());
  EXPECT_TRUE(
      std::includes(values.begin(), values.end(), types.begin(), types.end()));
  const Keys formats = AskedOfSensor("type: position\n    format: zzzz");
  EXPECT_TRUE(std::includes(values.begin(), values.end(), formats.begin(),
                            formats.end()));
  Keys asked;
  Keys estimated;
  for (const std::string& sensor : sensors) {
    const Keys keys = AskedOfSensor(sensor);
    asked.insert(keys.begin(), keys.end());
    const Keys inner =
        AskedOfSensor(sensor + "\n    estimate: {" + kUnknown + "}\n    #");
    estimated.insert(inner.begin(), inner.end());
    // A disturbance has a time of its own.
    if (inner.contains("disturbance")) estimated.insert("disturbance_tau");
  }
  const Keys constraint = Asked(
      "aiding:\n  s: {type: non_holonomic, rate: 1 Hz, sigma: [1 m/s, 1 "
      "m/s], " +
      std::string(kUnknown) + "}\n");
  asked.insert(constraint.begin(), constraint.end());
  asked.insert("topic");
  asked.insert("columns");
  EXPECT_EQ(asked, Known({"stream", "aiding"}));
  EXPECT_EQ(estimated, Known({"estimate"}));
}

/// The documentation has the keys that are asked for, and no others.
TEST_F(ConfigKeys, AreThoseOfTheDocumentation) {
  Keys sensors;
  Keys estimated = {"time_offset"};
  for (const KeySection& section : ConfigSections()) {
    Keys keys;
    for (const KeyEntry& key : section.keys) {
      if (key.name.starts_with("estimate.")) {
        estimated.insert(key.name.substr(9));
      } else {
        keys.insert(key.name.substr(0, key.name.find('.')));
      }
    }
    if (section.name.starts_with("aiding")) {
      sensors.merge(keys);
    } else {
      EXPECT_EQ(keys, Known({section.name.empty() ? "top" : section.name}))
          << section.name;
    }
  }
  // Of the stream, which has them beside.
  Keys known = Known({"aiding"});
  EXPECT_EQ(sensors, known);
  EXPECT_EQ(estimated, Known({"estimate"}));
}

/// A scenario's parts, of which `unknown` replaces one.
class ScenarioKeys : public ConfigKeys {
 protected:
  Keys AskedOf(const std::string& part, const std::string& unknown) const {
    std::map<std::string, std::string> parts = {
        {"segments", "[{type: straight, duration: 5 s}]"},
        {"imu", "{noise: {gyro: 0.1 deg/sqrt(h), accel: 70 ug/sqrt(Hz)}}"},
        {"start", "{position: [48 deg, 11 deg, 500 m]}"},
        {"start_errors", "{position: 1 m, velocity: 1 m/s, attitude: 1 deg}"}};
    parts[part] = unknown;
    std::string text;
    for (const auto& [key, value] : parts) text += key + ": " + value + "\n";
    Write("scenario.yaml", text);
    try {
      LoadScenario(Path("scenario.yaml"));
    } catch (const InputError& error) {
      const std::vector<std::string> keys = Expected(error.what());
      return {keys.begin(), keys.end()};
    }
    ADD_FAILURE() << text;
    return {};
  }
};

TEST_F(ScenarioKeys, AreThoseOfTheFuzzer) {
  const std::string zzzz = "zzzz: 1";
  const auto known = [](const std::string& map) {
    return Known({map}, ScenarioMaps());
  };
  Keys top = AskedOf("zzzz", "1");
  // Each stands in the place of others.
  top.insert({"profile", "wander", "segments", "start", "aiding", "duration",
              "withhold", "way_points", "inject", "start_errors"});
  EXPECT_EQ(top, known("top"));
  Keys segment;
  for (const std::string keys :
       {"type: straight, duration: 1 s", "type: stop, duration: 1 s",
        "type: accelerate, speed: 1 m/s, rate: 1 m/s^2",
        "type: turn, angle: 1 deg, rate: 1 deg/s",
        "type: repeat, segments: [{type: straight, duration: 1 s}]",
        "type: pitch, angle: 1 deg, rate: 1 deg/s"}) {
    segment.merge(AskedOf("segments", "[{" + keys + ", " + zzzz + "}]"));
  }
  EXPECT_EQ(segment, known("segment"));
  EXPECT_EQ(AskedOf("imu",
                    "{noise: {gyro: 0.1 deg/sqrt(h), accel: 70 ug/sqrt(Hz)}, " +
                        zzzz + "}"),
            known("scenario_imu"));
  Keys sensor;
  for (const std::string keys :
       {"type: position, sigma: 1 m, frame: enu, origin: [48 deg, 11 deg, 0 "
        "m]",
        "type: position, sigma: 1 m, frame: utm, zone: 32",
        "type: velocity, sigma: 1 m/s", "type: height, sigma: 1 m",
        "type: dvl, sigma: 1 m/s, form: beams", "type: odometer, sigma: 1 m/s",
        "type: odometer, form: increments, sigma: 1 m",
        "type: speed_course, sigma: 1 m/s, course_sigma: 1 deg",
        "type: magnetometer, form: vector, sigma: 1 uT, horizontal: 20 uT, "
        "down: 40 uT",
        "type: heading, sigma: 1 deg", "type: zero_velocity, sigma: 1 cm/s",
        "type: acoustic, sigma: 1 m, bearing_sigma: 1 deg, transponder: [48 "
        "deg, 11 deg, 0 m]"}) {
    sensor.merge(AskedOf("aiding", "{s: {" + keys + ", " + zzzz + "}}"));
  }
  EXPECT_EQ(sensor, known("scenario_sensor"));
}

}  // namespace
}  // namespace hindsight
