#include <fmt/core.h>
#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "io/config/init_config.h"
#include "io/recording_folder.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;

constexpr int kRows = 500;
constexpr double kStep = 0.01;      // s
constexpr int kFirst = 1751225661;  // 2025-06-29 19:34:21 UTC

/// How the stamps of an IMU are written down.
struct StampForm {
  const char* name;
  const char* titles;
  std::function<std::string(int row)> stamp;
  const char* line;  ///< of the configuration
};

void PrintTo(const StampForm& form, std::ostream* out) { *out << form.name; }

class StampForms : public RecordingFolder,
                   public ::testing::WithParamInterface<StampForm> {};

TEST_P(StampForms, AreOneClock) {
  std::string text = std::string(GetParam().titles) + ",gx,gy,gz,ax,ay,az\n";
  for (int k = 0; k < kRows; ++k) {
    text += fmt::format("{},0.00{},0.00{},0.00{},0.0{},0.1,-9.8{}\n",
                        GetParam().stamp(k), k % 7, k % 5, k % 3, k % 7, k % 9);
  }
  Write("imu.csv", text);
  const auto drafts = DraftRecordings(folder_.string());
  ASSERT_EQ(drafts.size(), 1u);
  const std::string config = DraftText(drafts[0]);
  EXPECT_THAT(config, HasSubstr(GetParam().line));
  Write("config.yaml", config);
  ASSERT_EQ(LoadError(), "") << config;
  const Dataset data = Load();
  ASSERT_EQ(data.imu.samples.size(), static_cast<std::size_t>(kRows));
  for (const std::size_t k : {1u, 250u, 499u}) {
    EXPECT_NEAR(data.imu.samples[k].t - data.imu.samples[0].t,
                kStep * static_cast<double>(k), 2e-6)
        << k;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, StampForms,
    ::testing::Values(
        StampForm{
            "SecondsAndNanoseconds", "header.stamp.sec,header.stamp.nanosec",
            [](int k) {
              return fmt::format("{},{}", kFirst + k / 100, k % 100 * 10000000);
            },
            "t_rest: \"2 [ns]\""},
        StampForm{"SecondsAndMicroseconds", "tv_sec,tv_usec",
                  [](int k) {
                    return fmt::format("{},{}", kFirst + k / 100,
                                       k % 100 * 10000);
                  },
                  "t_rest: \"2 [us]\""},
        StampForm{"Minutes", "Time (min)",
                  [](int k) { return fmt::format("{:.9f}", k * kStep / 60.0); },
                  "t: \"1 [min]\""},
        StampForm{
            "Hours", "Time [h]",
            [](int k) { return fmt::format("{:.11f}", k * kStep / 3600.0); },
            "t: \"1 [h]\""},
        StampForm{"NamesOfMonths", "DateTime",
                  [](int k) {
                    return fmt::format("29-Jun-2025 19:34:{:06.3f}",
                                       21.0 + k * kStep);
                  },
                  "t: \"1 [UTC]\""}),
    [](const auto& info) { return std::string(info.param.name); });

class StampKeys : public RecordingFolder {
 protected:
  std::string ErrorOf(const std::string& columns, const std::string& row,
                      const std::string& keys = "") {
    std::string text = "0 0 0 0 0 0 -9.8 0\n" + row + "\n";
    Write("imu.txt", text);
    Write("config.yaml",
          "imu:\n  file: imu.txt\n  format: columns\n  columns: {" + columns +
              ", gyro_x: \"3 [rad/s]\", gyro_y: \"4 [rad/s]\", gyro_z: \"5 "
              "[rad/s]\", accel_x: \"6 [m/s^2]\", accel_y: \"6 [m/s^2]\", "
              "accel_z: \"7 [m/s^2]\"}\n" +
              keys +
              "  noise: {gyro: 0.1 deg/sqrt(h), "
              "accel: 0.1 m/s/sqrt(h)}\n");
    return LoadError();
  }
};

TEST_F(StampKeys, ANumberThatStandsHasNoRestBesideIt) {
  std::string text = "device,time,gx,gy,gz,ax,ay,az\n";
  for (int k = 0; k < kRows; ++k) {
    text +=
        fmt::format("0,{},0.00{},0.00{},0.00{},0.0{},0.1,-9.8{}\n",
                    600000000 + 10000 * k, k % 7, k % 5, k % 3, k % 7, k % 9);
  }
  Write("imu.csv", text);
  const auto drafts = DraftRecordings(folder_.string());
  ASSERT_EQ(drafts.size(), 1u);
  const std::string config = DraftText(drafts[0]);
  EXPECT_THAT(config, HasSubstr("t: \"2 [us]\""));
  EXPECT_THAT(config, ::testing::Not(HasSubstr("t_rest")));
}

TEST_F(StampKeys, AreWholeAndTheRestIsBelowOne) {
  // In either order.
  const std::string good = "t_rest: \"2 [ns]\", t: \"1 [s]\"";
  EXPECT_EQ(ErrorOf(good, "0 10000000 0 0 0 0 -9.8 0"), "");
  EXPECT_THAT(ErrorOf(good, "0 1000000000 0 0 0 0 -9.8 0"),
              HasSubstr("imu.txt:2: column 1 (time): '0 1000000000' is not a "
                        "time"));
  EXPECT_THAT(ErrorOf(good, "0.5 10 0 0 0 0 -9.8 0"),
              HasSubstr("is not a time"));
  EXPECT_THAT(ErrorOf(good, "0 -10 0 0 0 0 -9.8 0"), HasSubstr("not a time"));
  EXPECT_THAT(ErrorOf("t_rest: \"2 [s]\", t: \"1 [s]\"", ""),
              HasSubstr("expected ns, us or ms"));
  EXPECT_THAT(ErrorOf("t_rest: \"2 [ns]\", t: \"1 [ms]\"", ""),
              HasSubstr("goes with a column t of whole seconds"));
}

TEST_F(StampKeys, KeysOfRowsAndBadValuesSayWhatTheyExpect) {
  const auto error = [this](const std::string& keys) {
    return ErrorOf("t: \"1 [s]\"", "1 0 0 0 0 0 -9.8 0", keys);
  };
  EXPECT_THAT(error("  rows: {column: 1, word: x, device: 0}\n"),
              HasSubstr("expected `device_column` and `device` together"));
  EXPECT_THAT(error("  rows: {column: 1, word: x, device_column: 2}\n"),
              HasSubstr("expected `device_column` and `device` together"));
  EXPECT_THAT(
      error("  rows: {column: 1, word: x, device_column: 0, device: 0}\n"),
      HasSubstr("device_column: expected 1 or more"));
  EXPECT_THAT(
      error("  rows: {column: 1, word: x, device_column: 2, device: 7}\n"),
      HasSubstr("no rows that have 'x' in column 1 and '7' in column 2"));
  EXPECT_THAT(error("  bad_values: [-999, none]\n"),
              HasSubstr("bad_values: 'none' is not a number"));
  Write("config.yaml",
        "imu:\n  file: imu.txt\n  bad_values: [1]\n  noise: {gyro: 0.1 "
        "deg/sqrt(h), accel: 0.1 m/s/sqrt(h)}\n");
  EXPECT_THAT(LoadError(), HasSubstr("is of `format: columns`"));
  Write("imu.npy", "x");
  Write("config.yaml",
        "imu:\n  file: imu.npy\n  format: npy\n  columns: {"
        "t_rest: \":2 [ns]\"}\n  noise: {gyro: 0.1 deg/sqrt(h), accel: 0.1 "
        "m/s/sqrt(h)}\n");
  EXPECT_THAT(LoadError(), HasSubstr("t_rest is a column of texts alone"));
}

}  // namespace
}  // namespace hindsight
