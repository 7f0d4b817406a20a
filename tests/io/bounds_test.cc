#include <gtest/gtest.h>

#include "base/error.h"
#include "dataset/timeline_builder.h"
#include "io/config/scenario_config.h"
#include "io/recording_folder.h"
#include "io/sample_stream_list.h"
#include "simulation/scenario.h"

namespace hindsight {
namespace {

/// Every list that a configuration can make has a bound, which its error says.
class Bounds : public RecordingFolder {
 protected:
  /// What loading says with these keys, of the imu and besides.
  std::string ErrorWith(const std::string& imu, const std::string& rest) const {
    Write("imu.csv", Encode(RestingImu(), RestingImu().table));
    Write("gnss.csv",
          "t[s],lat[deg],lon[deg],h[m]\n0,48,11,500\n0.5,48,11,500\n"
          "1,48,11,500\n");
    Write("config.yaml",
          "imu:\n  file: imu.csv\n"
          "  noise: {gyro: 0.2 deg/sqrt(h), accel: 70 ug/sqrt(Hz)}\n" +
              imu + rest);
    return LoadError();
  }
  std::string ErrorWithGnss(const std::string& keys,
                            const std::string& rest = "") const {
    return ErrorWith("",
                     "aiding:\n  gnss: {type: position, file: gnss.csv, "
                     "sigma: 1 m" +
                         keys + "}\n" + rest);
  }
  std::string ScenarioError(const std::string& motion,
                            const std::string& sensors = "") const {
    Write(
        "scenario.yaml",
        "start: {position: [48 deg, 11 deg, 500 m]}\n" + motion +
            "imu:\n  noise: {gyro: 0.2 deg/sqrt(h), accel: 70 ug/sqrt(Hz)}\n" +
            sensors);
    try {
      Simulation(LoadScenario(Path("scenario.yaml")), 1);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
};

#define EXPECT_SAYS(error, words) \
  EXPECT_NE((error).find(words), std::string::npos) << (error)

TEST_F(Bounds, OfOutages) {
  const auto withhold = [](const std::string& every) {
    return "withhold:\n  - {sensor: gnss, every: " + every +
           ", length: 1 us}\n";
  };
  EXPECT_SAYS(ErrorWithGnss("", withhold("1 us")),
              "config.yaml:6: withhold: every 1e-06 s makes 1e+06 outages of "
              "'gnss'; expected at most 100000");
  EXPECT_EQ(ErrorWithGnss("", withhold("10 us")), "");
}

TEST_F(Bounds, OfThinningIsNone) {
  EXPECT_EQ(ErrorWithGnss(", every: 1e-300 s"), "");
}

TEST_F(Bounds, OfSkippedLines) {
  EXPECT_SAYS(ErrorWithGnss(", skip_lines: 1000000000"), "no rows of data");
}

TEST_F(Bounds, OfColumns) {
  EXPECT_SAYS(
      ErrorWithGnss(", format: columns, columns: {t: '100001 [s]', lat: "
                    "'2 [deg]', lon: '3 [deg]', h: '4 [m]'}"),
      "aiding.gnss.columns.t: expected a column of 1 to 100000");
  EXPECT_SAYS(
      ErrorWithGnss(", format: columns, columns: {t: {column: 99999999999, "
                    "unit: s}}"),
      "expected a column of 1 to 100000");
}

TEST_F(Bounds, OfGeneratedMeasurements) {
  const auto rate = [&](const std::string& value) {
    return ErrorWith("", "aiding:\n  nhc: {type: non_holonomic, rate: " +
                             value + ", sigma: [1 m/s, 1 m/s]}\n");
  };
  EXPECT_EQ(rate("10 Hz"), "");
  EXPECT_SAYS(rate("1e9 Hz"),
              "expected at most 400, ten for each sample of the IMU");
}

TEST_F(Bounds, OfWhatAVehicleHolds) {
  EXPECT_EQ(ErrorWithGnss(", lever_arm: [999, 0, 0 m]"), "");
  EXPECT_SAYS(ErrorWithGnss(", lever_arm: [0, 900, -900 m]"),
              "config.yaml:5: aiding.gnss.lever_arm: is 1273 m long; expected "
              "at most 1000 m from the IMU");
}

TEST_F(Bounds, OfWhatThereIsOnTheEarth) {
  EXPECT_SAYS(ErrorWithGnss(", lever_arm: [5e9, 0, 0 m]"),
              "config.yaml:5: aiding.gnss.lever_arm: is 5e+09 m; expected at "
              "most 1e+07 m");
  EXPECT_SAYS(ErrorWithGnss("", "initial: {velocity_sigma: -1e9 m/s}\n"),
              "initial.velocity_sigma: is -1e+09 m/s; expected at most 1e+05");
  EXPECT_SAYS(ErrorWithGnss("", "initial: {accel_bias: [0, 1e9, 0 m/s^2]}\n"),
              "initial.accel_bias: is 1e+09 m/s^2; expected at most 1e+04");
  EXPECT_EQ(ErrorWithGnss("", "initial: {velocity_sigma: 1e4 m/s}\n"), "");
}

TEST_F(Bounds, OfTheNodesIsTheImusInterval) {
  EXPECT_SAYS(ErrorWithGnss("", "nodes: {max_spacing: 1e-9 s}\n"),
              "config.yaml:6: nodes.max_spacing: is 1e-09 s, shorter than the "
              "IMU's sample interval of");
  EXPECT_EQ(ErrorWithGnss("", "nodes: {max_spacing: 0.5 s}\n"), "");
}

TEST_F(Bounds, OfTheRecordsLength) {
  EXPECT_SAYS(ErrorWith("  time: {duration: 1e9 s}\n", ""),
              "expected at most 31 days");
}

TEST_F(Bounds, OfTheRulesWindow) {
  EXPECT_SAYS(ErrorWith("", "ahrs: {rule: smnc, samples: 1000001}\n"),
              "ahrs.samples: expected at most 1000000");
  EXPECT_SAYS(ErrorWith("", "ahrs: {rule: smnc, seconds: 2 h}\n"),
              "ahrs.seconds: expected at most 3600 s");
}

TEST_F(Bounds, OfWhatTheRuleHasNoUseFor) {
  EXPECT_SAYS(ErrorWith("", "ahrs: {gate: 1 m/s^2}\n"),
              "ahrs.gate: has no use with rule: fixed; expected it beside "
              "rule: gate or held_gate");
  for (const std::string key : {"lambda: 10 %", "samples: 3", "seconds: 1 s"}) {
    EXPECT_SAYS(ErrorWith("", "ahrs: {rule: gate, " + key + "}\n"),
                "ahrs." + key.substr(0, key.find(':')) +
                    ": has no use with rule: gate");
    EXPECT_EQ(ErrorWith("", "ahrs: {rule: smnc, " + key + "}\n"), "");
  }
  EXPECT_EQ(ErrorWith("", "ahrs: {rule: held_gate, gate: 1 m/s^2}\n"), "");
  EXPECT_SAYS(ErrorWith("", "ahrs: {rule: gate, gate: 0 m/s^2}\n"),
              "ahrs.gate: must be greater than zero");
  EXPECT_SAYS(ErrorWith("", "ahrs: {rule: smnc, lambda: -10 %}\n"),
              "ahrs.lambda: must not be negative");
}

TEST_F(Bounds, OfTheConfigurationItself) {
  EXPECT_SAYS(ErrorWith("", std::string(5u << 20, '\n')),
              "config.yaml: is longer than 4 MB");
}

TEST_F(Bounds, OfNestedConfigurations) {
  const std::string open(3000, '[');
  const std::string close(3000, ']');
  EXPECT_EQ(ErrorWith("", "notes:\n  " + open + close + "\n"),
            "config.yaml: is nested too deep");
  Write("scenario.yaml", "start:\n  position: " + open + close + "\n");
  try {
    LoadScenario(Path("scenario.yaml"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_SAYS(std::string(error.what()), "scenario.yaml: is nested too deep");
  }
}

TEST_F(Bounds, OfNodes) {
  Dataset dataset;
  for (int i = 0; i < 1000; ++i) {
    ImuSample sample;
    sample.t = 0.001 * i;
    dataset.imu.samples.push_back(sample);
  }
  dataset.max_node_spacing = 0.0011;
  TimelineOptions options;
  options.t_end = 2e6;
  try {
    BuildTimeline(dataset, options);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_SAYS(std::string(error.what()), "expected at most 10000000");
  }
}

TEST_F(Bounds, OfSimulations) {
  EXPECT_SAYS(ScenarioError("wander: {duration: 1e12 s}\n"),
              "wander.duration: expected at most 31 days");
  EXPECT_SAYS(ScenarioError("segments: [{type: straight, duration: 1e12 s}]\n"),
              "expected at most 2678400");
  EXPECT_SAYS(
      ScenarioError("segments: [{type: straight, duration: 100 s}]\n",
                    "aiding:\n  gnss: {type: position, rate: 1e9 Hz, sigma: 1 "
                    "m}\n"),
      "measurements of a sensor; expected at most 10000000");
}

#undef EXPECT_SAYS

}  // namespace
}  // namespace hindsight
