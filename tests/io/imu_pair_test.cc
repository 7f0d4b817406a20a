#include <fmt/core.h>
#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <string>

#include "base/error.h"
#include "base/units.h"
#include "io/config/init_config.h"
#include "io/recording_folder.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kPairRate = 100.0;
constexpr int kPairRows = 3000;

/// Rocked about x by up to 0.6 rad.
double PairAngle(double t) { return 0.6 * std::sin(t); }

/// Rows at `from` + k / 100 s of those that `keep` keeps.
std::string HalfRows(
    const std::string& titles, bool gyros, double from,
    const std::function<bool(double)>& keep = [](double) { return true; }) {
  std::string text = titles;
  for (int k = 0; k < kPairRows; ++k) {
    const double t = from + k / kPairRate;
    if (!keep(t)) continue;
    const double angle = PairAngle(t);
    text += gyros ? fmt::format("{:.4f},{:.9f},0,0\n", t, 0.6 * std::cos(t))
                  : fmt::format("{:.4f},0,{:.9f},{:.9f}\n", t,
                                -kStandardGravity * std::sin(angle),
                                -kStandardGravity * std::cos(angle));
  }
  return text;
}

constexpr const char* kGyroTitles =
    "t[s],gyro_x[rad/s],gyro_y[rad/s],gyro_z[rad/s]\n";
constexpr const char* kAccelTitles =
    "t[s],accel_x[m/s^2],accel_y[m/s^2],accel_z[m/s^2]\n";

std::string PairConfig(const std::string& imu_keys = "",
                       const std::string& accel_keys = "") {
  return "name: pair\nfolder: .\nimu:\n  file: gyro.csv\n" + imu_keys +
         "  accelerometer: {file: accel.csv" + accel_keys +
         "}\n  noise: {gyro: 1 deg/sqrt(h), accel: 1 m/s/sqrt(h)}\n"
         "initial: {position: [50 deg, 8 deg, 100 m], attitude: [0, 0, 0 deg],"
         " position_sigma: 1 m, attitude_sigma: 1 deg}\n";
}

class ImuPair : public RecordingFolder {
 protected:
  static double DropPolicy(const Dataset& dataset) {
    for (const PolicyCount& policy : dataset.policies) {
      if (policy.action.find("without readings of accelerometers") !=
          std::string::npos) {
        return static_cast<double>(policy.count);
      }
    }
    return 0.0;
  }
};

TEST_F(ImuPair, AccelerometersAreInterpolatedAtTheStampsOfTheGyros) {
  Write("gyro.csv", HalfRows(kGyroTitles, true, 5.0));
  Write("accel.csv", HalfRows(kAccelTitles, false, 5.0043));
  Write("config.yaml", PairConfig());
  const Dataset dataset = Load();
  // The first row of the gyros comes before any reading of the accelerometers.
  ASSERT_EQ(dataset.imu.samples.size(), kPairRows - 1);
  EXPECT_EQ(DropPolicy(dataset), 1.0);
  EXPECT_DOUBLE_EQ(dataset.imu.samples.front().t, 5.01);
  // Of a straight line over h the error is h^2/8 times the second derivative.
  const double most = kStandardGravity * 1.0 * 1e-4 / 8.0;
  for (const ImuSample& sample : dataset.imu.samples) {
    const double angle = PairAngle(sample.t);
    EXPECT_NEAR(sample.gyro.x(), 0.6 * std::cos(sample.t), 1e-8);
    EXPECT_NEAR(sample.accel.y(), -kStandardGravity * std::sin(angle), most);
    EXPECT_NEAR(sample.accel.z(), -kStandardGravity * std::cos(angle), most);
  }
}

TEST_F(ImuPair, ADropOutOfTheAccelerometersIsADropOutOfTheImu) {
  Write("gyro.csv", HalfRows(kGyroTitles, true, 5.0));
  Write("accel.csv", HalfRows(kAccelTitles, false, 5.0,
                              [](double t) { return t < 10.0 || t > 10.3; }));
  Write("config.yaml", PairConfig());
  const Dataset dataset = Load();
  EXPECT_EQ(DropOuts(dataset.imu).size(), 1u);
  for (const ImuSample& sample : dataset.imu.samples) {
    EXPECT_FALSE(sample.t > 10.005 && sample.t < 10.295) << sample.t;
  }
  Write("config.yaml", PairConfig("  max_gap: 0.2 s\n"));
  EXPECT_THAT(LoadError(), HasSubstr("gyro.csv:533: gap of 0.320"));
}

TEST_F(ImuPair, WhatDoesNotGoTogetherIsRefused) {
  Write("gyro.csv", HalfRows(kGyroTitles, true, 5.0));
  Write("accel.csv", HalfRows(kAccelTitles, false, 5.0));
  Write("config.yaml", PairConfig("", ", time: {start: 1 s}"));
  EXPECT_THAT(LoadError(),
              HasSubstr("accelerometer: is read on the clock of the gyros"));
  Write("config.yaml", PairConfig("  time: {rate: 100 Hz}\n"));
  EXPECT_THAT(LoadError(), HasSubstr("expected no `time` of its own"));
  Write("config.yaml", PairConfig("", ", file2: a"));
  EXPECT_THAT(LoadError(), HasSubstr("file2"));
  Write("accel.csv", HalfRows(kGyroTitles, true, 5.0));
  Write("config.yaml", PairConfig());
  EXPECT_THAT(LoadError(), HasSubstr("accel.csv: no column accel_x"));
  Write("accel.csv", HalfRows(kAccelTitles, false, 105.0));
  EXPECT_THAT(LoadError(), HasSubstr("holds 0 IMU samples"));
  Write("gyro.csv",
        "t[s],gyro_x[rad/s],gyro_y[rad/s],gyro_z[rad/s],accel_x[m/s^2]\n"
        "0,0,0,0,0\n");
  EXPECT_THAT(LoadError(), HasSubstr("accelerations stand in imu.file and in "
                                     "imu.accelerometer"));
}

TEST_F(ImuPair, TheResolvedConfigurationReadsTheSame) {
  Write("gyro.csv", HalfRows(kGyroTitles, true, 5.0));
  Write("accel.csv", HalfRows(kAccelTitles, false, 5.0043));
  Write("config.yaml", PairConfig("  time: {clock: unix}\n"));
  ResolvedConfig resolved;
  const Dataset first = Load(&resolved);
  Write("config.yaml", resolved.yaml);
  const Dataset again = Load();
  ASSERT_EQ(again.imu.samples.size(), first.imu.samples.size());
  EXPECT_EQ(again.imu.samples[7].accel, first.imu.samples[7].accel);
  const auto inputs = ConfigFilesRead(Path("config.yaml"), {});
  EXPECT_EQ(inputs.size(), 3u);
}

TEST_F(ImuPair, OfAPhonesLoggerIsRecognised) {
  std::filesystem::create_directories(folder_ / "walk");
  Write("walk/Gyroscope.csv",
        HalfRows("\"Time (s)\",\"X (rad/s)\",\"Y (rad/s)\",\"Z (rad/s)\"\n",
                 true, 5.0));
  Write("walk/Accelerometer.csv",
        HalfRows("\"Time (s)\",\"X (m/s^2)\",\"Y (m/s^2)\",\"Z (m/s^2)\"\n",
                 false, 5.0043));
  // What is without gravity is no half of an IMU.
  Write("walk/Accel linear.csv",
        HalfRows("\"Time (s)\",\"X (m/s^2)\",\"Y (m/s^2)\",\"Z (m/s^2)\"\n",
                 true, 5.0));
  const auto drafts = DraftRecordings(folder_.string());
  ASSERT_EQ(drafts.size(), 1u);
  const std::string text = DraftText(drafts[0]);
  for (const char* words :
       {"file: Gyroscope.csv\n",
        "  accelerometer:", "    file: \"Accelerometer.csv\"",
        "      accel_x: \"2 [m/s^2]\"", "    gyro_x: \"2 [rad/s]\""}) {
    EXPECT_THAT(text, HasSubstr(words));
  }
  EXPECT_THAT(text, Not(HasSubstr("Not recognised:\n#   Accelerometer.csv")));
  Write("config.yaml", text);
  const Dataset dataset = Load();
  EXPECT_EQ(dataset.imu.samples.size(), kPairRows - 1);
  EXPECT_NEAR(dataset.imu.samples[100].accel.norm(), kStandardGravity, 0.01);
}

TEST_F(ImuPair, WhoseClocksHaveNothingInCommonIsNamed) {
  std::filesystem::create_directories(folder_ / "walk");
  Write("walk/Gyroscope.csv", HalfRows(kGyroTitles, true, 5.0));
  Write("walk/Accelerometer.csv", HalfRows(kAccelTitles, false, 5000.0));
  try {
    DraftRecordings((folder_ / "walk").string());
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(
        error.what(),
        HasSubstr("Gyroscope.csv and Accelerometer.csv look like its "
                  "gyros and its accelerometers, but their times hardly "
                  "overlap: 5 to 34.99 s and 5000 to 5029.99 s"));
  }
}

}  // namespace
}  // namespace hindsight
