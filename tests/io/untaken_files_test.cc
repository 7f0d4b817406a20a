#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "io/config/init_config.h"
#include "io/recording_folder.h"

namespace hindsight {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// What 'init' does not take, and what stands before what it takes.
class UntakenFiles : public RecordingFolder {
 protected:
  /// `cells` of row k behind those of the IMU, which is rocked about x.
  template <typename Cells>
  static std::string ImuRows(const std::string& before, Cells cells) {
    std::string text = before;
    for (int k = 0; k < 1000; ++k) {
      const double phase = 0.01 * k;
      const double angle = 0.6 * std::sin(phase);
      text += fmt::format("{:.2f},{:.5f},{:.5f},{:.5f},{:.6f},0.001,0.002{}\n",
                          0.01 * k, 0.001 * (k % 7), 9.80665 * std::sin(angle),
                          9.80665 * std::cos(angle), 0.6 * std::cos(phase),
                          cells(k));
    }
    return text;
  }
  static std::string ImuRows(const std::string& before) {
    return ImuRows(before, [](int) { return std::string(); });
  }
  std::vector<std::string> Unknown() const {
    return DraftRecordings(folder_.string()).at(0).unknown;
  }
  std::string Error() const {
    try {
      DraftRecordings(folder_.string());
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(UntakenFiles, MeasuredColumnsThatNoStreamUsesAreNamed) {
  Write("imu.csv",
        ImuRows("time,ax,ay,az,gx,gy,gz,count,rate,temp,state,name,hdop_x\n",
                [](int k) {
                  return fmt::format(",{},100,{:.1f},{},moving,{:.1f}", k,
                                     20.0 + 0.1 * (k % 5), k % 2,
                                     1.0 + 0.1 * (k % 4));
                }));
  EXPECT_THAT(Unknown(), ElementsAre("imu.csv, columns temp, hdop_x"));
  // Without titles by their numbers.
  Write("imu.csv", ImuRows("", [](int k) {
          return fmt::format(",{}", 20 + 3 * (k % 5));
        }));
  EXPECT_THAT(Unknown(), ElementsAre("imu.csv, column 8"));
  Write("imu.csv", ImuRows("time,ax,ay,az,gx,gy,gz\n"));
  EXPECT_THAT(Unknown(), IsEmpty());
}

TEST_F(UntakenFiles, HalvesOfAnImuNameTheirOtherColumns) {
  for (const char* name : {"gyro.csv", "accel.csv"}) {
    std::string text = "time,x,y,z,temp\n";
    for (int k = 0; k < 1000; ++k) {
      const double phase = 0.01 * k;
      const double angle = 0.6 * std::sin(phase);
      text += name[0] == 'g' ? fmt::format("{:.2f},{:.6f},0,0.001", 0.01 * k,
                                           0.6 * std::cos(phase))
                             : fmt::format("{:.2f},0.01,{:.6f},{:.6f}",
                                           0.01 * k, 9.80665 * std::sin(angle),
                                           9.80665 * std::cos(angle));
      text += fmt::format(",{}\n", 20 + k % 5);
    }
    Write(name, text);
  }
  EXPECT_THAT(Unknown(),
              ElementsAre("accel.csv, column temp", "gyro.csv, column temp"));
}

TEST_F(UntakenFiles, WhatIsNoTextOfColumnsIsToldFor) {
  const std::string zeros("\x01\x00\x02\x00", 4);
  struct Case {
    const char* name;
    std::string text;
    const char* why;
  };
  const Case cases[] = {
      {"imu.jsonl", "{\"ts\": 1, \"ax\": 0}\n{\"ts\": 2, \"ax\": 0}\n",
       "imu.jsonl is JSON, which is not read: convert it to columns (CSV)"},
      {"imu.json", "[\n  [1, 2, 3],\n  [4, 5, 6]]\n", "is JSON"},
      {"drive.zip", "PK\x03\x04 and more", "is packed: unpack it"},
      {"drive.xlsx", "PK\x03\x04 and more", "save it as CSV"},
      {"log.bin", zeros, "is binary, in no format that is read"}};
  for (const Case& one : cases) {
    Write(one.name, one.text);
    EXPECT_THAT(Error(), HasSubstr(one.why));
    EXPECT_THAT(Error(), Not(HasSubstr("format: columns")));
    std::filesystem::remove(Path(one.name));
  }
  Write("imu.txt", "nothing at all\n");
  EXPECT_THAT(Error(), HasSubstr("with `format: columns`"));
  // Beside a recording it is named with what it is.
  Write("imu.csv", ImuRows("time,ax,ay,az,gx,gy,gz\n"));
  Write("log.bin", zeros);
  EXPECT_THAT(
      Unknown(),
      ElementsAre("imu.txt",
                  "log.bin, which is binary, in no format that is read: "
                  "convert it to columns (CSV)"));
}

TEST_F(UntakenFiles, ManyLinesMayStandBeforeTheNumbers) {
  for (const char* line : {"# calibration: 0.1 4.5 6.7\n",
                           "Survey notes; operator: Max, weather: 12 C\n"}) {
    std::string before;
    for (int k = 0; k < 3000; ++k) before += line;
    Write("imu.csv", ImuRows(before + "time,ax,ay,az,gx,gy,gz\n"));
    Write("config.yaml", DraftText(DraftRecordings(folder_.string()).at(0)));
    ASSERT_EQ(LoadError(), "") << line;
    EXPECT_EQ(Load().imu.samples.size(), 1000u) << line;
  }
}

TEST_F(UntakenFiles, NamesOfFilesAndTitlesComeBeforeSizes) {
  // Of a pair with counts beside, which look like gyros of the other.
  for (const bool gyro : {true, false}) {
    std::string text = "Timestamp,x,y,z,scaling,x_raw,y_raw,z_raw\n";
    for (int k = 0; k < 1000; ++k) {
      const double phase = 0.01 * k;
      const double angle = 0.6 * std::sin(phase);
      const double v[3] = {gyro ? 0.6 * std::cos(phase) : 0.001 * (k % 7),
                           gyro ? 0.0005 * (k % 3) : 9.80665 * std::sin(angle),
                           gyro ? 0.0005 * (k % 5) : 9.80665 * std::cos(angle)};
      text +=
          fmt::format("{},{:.6f},{:.6f},{:.6f},0.002,{:.0f},{:.0f},{:.0f}\n",
                      5000000 + 10000 * k, v[0], v[1], v[2], 400.0 * v[0],
                      400.0 * v[1], 400.0 * v[2]);
    }
    Write(gyro ? "RawGyro.csv" : "RawAccel.csv", text);
  }
  const std::string config = DraftText(DraftRecordings(folder_.string()).at(0));
  EXPECT_THAT(config, HasSubstr("imu:\n  file: RawGyro.csv\n"));
  EXPECT_THAT(config, HasSubstr("file: \"RawAccel.csv\""));
  EXPECT_THAT(config, HasSubstr("gyro_x: \"2 [rad/s]\""));
  EXPECT_THAT(config, HasSubstr("accel_x: \"2 [m/s^2]\""));
}

TEST_F(UntakenFiles, TitlesComeBeforeTheNumberOfColumns) {
  std::string text =
      "%  Time  IMU_X_ACC IMU_Y_ACC IMU_Z_ACC IMU_YAW_VEL IMU_ROLL_VEL "
      "IMU_PITCH_VEL IMU_YAW\n";
  for (int k = 0; k < 1000; ++k) {
    text += fmt::format(" {:.2f} {:.4f} 0.01 9.80 {:.5f} 0.0001 0.0002 0.1\n",
                        0.01 * k, 0.001 * (k % 9), 0.001 * (k % 11));
  }
  Write("imu.txt", text);
  const std::string config = DraftText(DraftRecordings(folder_.string()).at(0));
  EXPECT_THAT(config, HasSubstr("format: columns"));
  EXPECT_THAT(config, HasSubstr("accel_x: \"2 ["));
  EXPECT_THAT(config, HasSubstr("gyro_x: \"6 ["));
  EXPECT_THAT(config, HasSubstr("gyro_z: \"5 ["));
}

}  // namespace
}  // namespace hindsight
