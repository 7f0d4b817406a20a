#include "io/config/init_config.h"

#include <fmt/core.h>

#include "io/read/units.h"
#include "io/recording_folder.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

std::string InitConfig(const std::string& folder) {
  const auto drafts = DraftRecordings(folder);
  EXPECT_EQ(drafts.size(), 1u);
  return DraftText(drafts.front());
}

class InitConfigTest : public RecordingFolder {};

TEST_F(InitConfigTest, WhatItWritesLoads) {
  std::string imu =
      "t[s],dtheta_x[rad],dtheta_y[rad],dtheta_z[rad],dvel_x[m/s],dvel_y[m/s],"
      "dvel_z[m/s]\n";
  for (int i = 0; i < 100; ++i) {
    imu += std::to_string(0.01 * i) + ",0,0,0,0,0,-0.098\n";
  }
  WriteGzip("a.csv.gz", imu);
  Write("b.csv",
        "t[s],lat[deg],lon[deg],h[m],sigma_n[m],sigma_e[m],sigma_d[m]\n"
        "0,50,8,100,1,1,1\n1,50,8,100,1,1,1\n");
  Write("c.txt",
        "0.0 50 8 100 1 1 1\n0.5 50 8 100 1 1 1\n0.9 50 8 100 1 1 1\n");
  Write("d_truth.csv",
        "t[s],roll[deg],pitch[deg],heading[deg]\n0,1,2,3\n1,1,2,3\n");
  Write("notes.md", "Nothing to read here.\n");
  const std::string config = InitConfig(folder_.string());
  EXPECT_NE(config.find("#   notes.md"), std::string::npos) << config;
  Write("config.yaml", config);
  EXPECT_EQ(LoadError(), "");
  const Dataset data = Load();
  // Where the first interval begins, and its rows.
  EXPECT_EQ(data.imu.samples.size(), 1u + 100u);
  ASSERT_EQ(data.streams.size(), 2u);
  EXPECT_EQ(data.streams[0].measurements.size(), 2u);
  EXPECT_EQ(data.streams[1].measurements.size(), 3u);
  EXPECT_EQ(data.truth.size(), 2u);
}

constexpr const char* kFewImuRows =
    "t[s],gyro_x[rad/s],gyro_y[rad/s],gyro_z[rad/s],accel_x[m/s^2],"
    "accel_y[m/s^2],accel_z[m/s^2]\n"
    "0,0,0,0,0,0,-9.8\n0.01,0,0,0,0,0,-9.8\n0.02,0,0,0,0,0,-9.8\n";

TEST_F(InitConfigTest, PositionsWithoutSigmasAreAidingUnlessNamedTruth) {
  Write("imu.csv", kFewImuRows);
  const auto fixes = [](int height) {
    return fmt::format("t[s],lat[deg],lon[deg],h[m]\n0,50,8,{0}\n1,50,8,{0}\n",
                       height);
  };
  Write("a.csv", fixes(1));
  Write("b.csv", fixes(2));
  Write("refit.csv", fixes(3));  // no word of which is "ref"
  Write("config.yaml", InitConfig(folder_.string()));
  EXPECT_EQ(LoadError(), "");
  EXPECT_EQ(Load().streams.size(), 3u);
  EXPECT_TRUE(Load().truth.empty());
  for (const char* name : {"a_gt.csv", "GroundTruth.csv", "reference-1.csv"}) {
    SCOPED_TRACE(name);
    Write(name, fixes(4));
    const std::string config = InitConfig(folder_.string());
    EXPECT_NE(config.find("truth:\n  file: " + std::string(name)),
              std::string::npos)
        << config;
    std::filesystem::remove(Path(name));
  }
}

TEST_F(InitConfigTest, AnAttitudeIsNoTruthUntilTheUserSaysSo) {
  Write("imu.csv", kFewImuRows);
  Write("ins.csv",
        "t[s],roll[deg],pitch[deg],heading[deg]\n0,1,2,3\n1,1,2,3\n");
  const std::string config = InitConfig(folder_.string());
  EXPECT_NE(config.find("# truth:\n#   file: ins.csv"), std::string::npos)
      << config;
  Write("config.yaml", config);
  EXPECT_EQ(LoadError(), "");
  EXPECT_TRUE(Load().truth.empty());
}

TEST_F(InitConfigTest, PlacesOfASolutionWithAttitudesAreNoAiding) {
  Write("imu.csv", kFewImuRows);
  Write("ins.csv",
        "t[s],lat[deg],lon[deg],h[m],roll[deg],pitch[deg],heading[deg]\n"
        "0,50,8,1,1,2,3\n1,50,8,1,1,2,3\n");
  const std::string config = InitConfig(folder_.string());
  EXPECT_NE(config.find("aiding: {}"), std::string::npos) << config;
  EXPECT_NE(config.find("# truth:\n#   file: ins.csv"), std::string::npos)
      << config;
}

TEST_F(InitConfigTest, WithoutAnImuItFailsAndNamesWhatThereIs) {
  Write("fixes.csv", "t[s],lat[deg],lon[deg],h[m]\n0,50,8,1\n1,50,8,1\n");
  Write("flight.ulg", "ULog\x01");
  try {
    DraftRecordings(folder_.string());
    FAIL() << "expected an error";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("no IMU was recognised"), std::string::npos) << text;
    EXPECT_NE(text.find("fixes.csv (position)"), std::string::npos) << text;
    EXPECT_NE(text.find("flight.ulg"), std::string::npos) << text;
    EXPECT_EQ(text.find("imu.csv"), std::string::npos) << text;
  }
}

TEST_F(InitConfigTest, PosesOfTheTumBenchmarkAreNoImu) {
  Write("imu.csv", kFewImuRows);
  Write("poses.txt",
        "0.00 1 2 3 0 0 0.6 0.8\n0.01 1 2 3 0 0 0.6 0.8\n"
        "0.02 1 2 3 0 0 0.6 0.8\n");
  const std::string config = InitConfig(folder_.string());
  EXPECT_NE(config.find("# Not recognised:\n#   poses.txt"), std::string::npos)
      << config;
  EXPECT_EQ(config.find("file: poses.txt"), std::string::npos) << config;
}

TEST_F(InitConfigTest, NamesOfFilesThatYamlWouldReadOtherwiseAreQuoted) {
  Write("imu #1: left.csv", kFewImuRows);
  Write("config.yaml", InitConfig(folder_.string()));
  EXPECT_EQ(LoadError(), "");
}

TEST_F(InitConfigTest, FormatsOfOthersAreRecognised) {
  const std::string data = std::string(HINDSIGHT_SOURCE_DIR) + "/tests/data/";
  for (const char* folder : {"euroc", "nclt", "oxts"}) {
    SCOPED_TRACE(folder);
    std::filesystem::remove_all(Path("in"));
    std::filesystem::create_directories(Path("in"));
    const bool whole = std::string(folder) == "oxts";
    std::filesystem::copy(data + folder, Path(whole ? "in/oxts" : "in"),
                          std::filesystem::copy_options::recursive);
    const std::string config = InitConfig(Path("in"));
    EXPECT_NE(config.find("format: " + std::string(folder)), std::string::npos);
    Write("config.yaml", config);
    EXPECT_EQ(LoadError(), "");
  }
  std::filesystem::remove_all(Path("in"));
  std::filesystem::create_directories(Path("in"));
  Write("in/imu.csv", kFewImuRows);
  std::filesystem::copy(data + "nmea/drive.nmea", Path("in/drive.nmea"));
  Write("in/points.txt", "0.5 50 8 -100 0.3\n0.9 50 8 -100 0.3\n");
  const std::string config = InitConfig(Path("in"));
  EXPECT_NE(config.find("format: nmea"), std::string::npos) << config;
  EXPECT_NE(config.find("type: speed_course"), std::string::npos) << config;
  EXPECT_NE(config.find("format: control_points"), std::string::npos) << config;
}

/// A file of the kind's own columns, all of them 1, and the draft of it.
TEST_F(InitConfigTest, EveryKindOfSensorIsKnownByItsColumns) {
  std::string imu =
      "t[s],gyro_x[rad/s],gyro_y[rad/s],gyro_z[rad/s],accel_x[m/s^2],accel_y[m/"
      "s^2],accel_z[m/s^2]\n";
  for (int i = 0; i < 300; ++i) {
    imu += std::to_string(0.01 * i) + ",0.01,0,0,0,0,-9.8\n";
  }
  for (const SensorKind* kind : SensorKinds()) {
    if (!kind->configured || kind->generated) continue;
    SCOPED_TRACE(kind->name);
    std::filesystem::remove_all(Path("in"));
    std::filesystem::create_directories(Path("in"));
    Write("in/imu.csv", imu);
    std::string head = "t[s]";
    std::string row;
    const auto add = [&](const FieldName& column) {
      head +=
          std::string(",") + column.name + "[" + SiUnit(column.quantity) + "]";
      row += ",1";
    };
    const MeasuredColumns measured = kind->measured(SettingsOf(*kind));
    for (std::size_t i = 0; i < measured.count + measured.sigmas; ++i) {
      add(kind->columns[measured.first + i]);
    }
    // What tells it from an odometer.
    if (kind == &SpeedCourseKind()) add(kind->columns[1]);
    Write("in/sensor.csv", head + "\n0" + row + "\n1" + row + "\n");
    const std::string config = InitConfig(Path("in"));
    EXPECT_NE(config.find("type: " + std::string(kind->name) + "\n"),
              std::string::npos)
        << config;
    Write("config.yaml", config);
    EXPECT_EQ(LoadError(), "") << config;
  }
}

TEST_F(InitConfigTest, MissingOrEmptyFolderIsAnError) {
  EXPECT_THROW(InitConfig(folder_.string()), InputError);
  EXPECT_THROW(InitConfig(Path("nowhere")), InputError);
}

}  // namespace
}  // namespace hindsight
