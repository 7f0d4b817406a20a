#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "io/binary_files.h"
#include "io/read/date_text.h"
#include "io/read/time_scale.h"
#include "io/sample_folder.h"

namespace hindsight {
namespace {

constexpr const char* kNpyImu =
    "  file: imu\n  format: npy\n"
    "  columns: {t: 't [ns]', gyro_x: 'gyro:1 [rad/s]', "
    "gyro_y: '-gyro:2 [rad/s]', gyro_z: 'gyro:3 [deg/s]', "
    "accel_x: 'accel.npy:1 [m/s^2]', accel_y: 'accel.npy:2 [m/s^2]', "
    "accel_z: 'accel.npy:3 [m/s^2]'}\n"
    "  time: {clock: unix}\n";
constexpr const char* kMatImu =
    "  file: trial.mat\n  format: mat\n"
    "  columns: {gyro_x: 'imu_gyr:1 [rad/s]', gyro_y: 'imu_gyr:2 [rad/s]', "
    "gyro_z: 'imu_gyr:3 [rad/s]', accel_x: 'imu_acc:1 [m/s^2]', "
    "accel_y: 'imu_acc:2 [m/s^2]', accel_z: 'imu_acc:3 [m/s^2]'}\n"
    "  time: {rate: 100 Hz}\n";

class ArrayFormats : public SampleFolder {};

TEST_F(ArrayFormats, NumpyArraysOfEveryOrderAndType) {
  const Dataset data = LoadSample(
      "npy", kNpyImu,
      "aiding:\n  gnss: {type: position, file: gnss.npy, format: npy, "
      "sigma: 2 m, columns: {t: '1 [s]', lat: '2 [deg]', lon: '3 [deg]', "
      "h: '4 [m]'}, time: {clock: unix}}\n");
  ASSERT_EQ(data.imu.samples.size(), 4u);
  // Fortran order: the columns follow each other in the file.
  EXPECT_TRUE(data.imu.samples[2].gyro.isApprox(
      Eigen::Vector3d(0.3, -3.0, 30.0 * kDegree), 1e-15));
  EXPECT_EQ(data.imu.samples[2].accel, Eigen::Vector3d(0.5, 0.25, -9.5));
  // Nanoseconds since 1970 keep their last digit.
  EXPECT_NEAR(data.imu.samples[3].t - data.imu.samples[2].t, 0.010000001,
              1e-12);
  ASSERT_EQ(data.streams[0].measurements.size(), 2u);
  EXPECT_NEAR(data.streams[0].measurements[1].t, 0.02, 1e-6);
  const auto fix = std::get<PositionFix>(data.streams[0].measurements[1].model);
  EXPECT_NEAR(GeodeticFromEcef(fix.p_e).latitude / kDegree, 48.1, 1e-10);
}

TEST_F(ArrayFormats, MatlabVariablesPlainAndCompressed) {
  const Dataset data =
      LoadSample("mat", kMatImu,
                 "truth:\n  file: trial.mat\n  format: mat\n  frame: enu\n"
                 "  absent_values: true\n  time: {rate: 100 Hz}\n"
                 "  columns: {q_w: 'opt_quat:1 [1]', q_x: 'opt_quat:2 [1]', "
                 "q_y: 'opt_quat:3 [1]', q_z: 'opt_quat:4 [1]'}\n");
  ASSERT_EQ(data.imu.samples.size(), 4u);
  EXPECT_EQ(data.imu.samples[1].gyro, Eigen::Vector3d(0.2, 2.0, 20.0));
  EXPECT_EQ(data.imu.samples[3].accel, Eigen::Vector3d(0.0, 0.5, 9.8));
  EXPECT_DOUBLE_EQ(data.imu.samples[3].t, 0.03);
  ASSERT_EQ(data.truth.size(), 4u);
  EXPECT_FALSE(data.truth[2].q_nb);
  // Sensor axes east, north, up turned 90 deg to the left: north, west, up.
  Eigen::Matrix3d C_nb;
  C_nb << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  EXPECT_TRUE(data.truth[3].q_nb->toRotationMatrix().isApprox(C_nb, 1e-12));
}

TEST_F(ArrayFormats, WhatDoesNotFitIsNamed) {
  struct Case {
    const char* folder;
    std::string imu;
    const char* says;
  };
  const Case cases[] = {
      {"npy", ReplacedOnce(kNpyImu, "gyro:3", "gyro:4"), "no column 4 of 3"},
      {"npy", ReplacedOnce(kNpyImu, "'gyro:3 [deg/s]'", "'gyro:3'"),
       "has no unit"},
      {"npy", ReplacedOnce(kNpyImu, "'gyro:3", "'gyros:3"), "gyros"},
      {"npy", ReplacedOnce(kNpyImu, "'gyro:3", "'../gnss.npy:3"),
       "2 rows and t 4"},
      {"npy", ReplacedOnce(kNpyImu, "t: 't [ns]'", "t: '../gnss.npy:1 [s]'"),
       "4 rows and ../gnss.npy 2"},
      {"npy", ReplacedOnce(kNpyImu, "t: 't [ns]', ", ""), "no column t"},
      {"mat", ReplacedOnce(kMatImu, "imu_acc:3", "acc:3"),
       "holds imu_gyr, imu_acc, opt_quat, sampling_rate, name"},
      {"mat", ReplacedOnce(kMatImu, "imu_acc:3", "name:1"), "no real matrix"},
  };
  for (const Case& c : cases) {
    const std::string error = SampleError(c.folder, c.imu);
    EXPECT_NE(error.find(c.says), std::string::npos) << error;
  }
}

TEST_F(ArrayFormats, DamagedNumpyFilesAreRefused) {
  std::filesystem::copy(Sample("npy/imu"), Path("imu"));
  const std::string good = Read("imu/gyro");
  const auto error = [&](const std::string& bytes) {
    Write("imu/gyro", bytes);
    Write("config.yaml",
          "imu:\n" + std::string(kNpyImu) +
              "  noise: {gyro: 0.2 deg/sqrt(h), accel: 70 ug/sqrt(Hz)}\n");
    return LoadError();
  };
  EXPECT_EQ(error(good), "");
  EXPECT_NE(error(good.substr(0, good.size() - 1)).find("95 bytes"),
            std::string::npos);
  EXPECT_NE(error(good.substr(0, 20)).find("within its NumPy header"),
            std::string::npos);
  EXPECT_NE(error("PK" + good).find("no NumPy file"), std::string::npos);
  EXPECT_NE(error(ReplacedOnce(good, "<f8", ">f8")).find("'>f8'"),
            std::string::npos);
  EXPECT_NE(error(ReplacedOnce(good, "(4, 3)", "(4,3,")).find("shape"),
            std::string::npos);
}

/// Whole numbers of minutes and of 3 ms, which no whole number of ticks a
/// second is, as int64 of both formats.
TEST_F(ArrayFormats, IntegerStampsKeepTheirUnitAndScale) {
  const std::string places =
      "t: {column: 'T', unit: U, scale: S}, lat: "
      "'P:1 [deg]', lon: 'P:2 [deg]', h: 'P:3 [m]'";
  const TextCells fixes(3, {"48", "11", "500"});
  std::string ticks;
  for (const std::int64_t tick : {0, 1, 5}) ticks += BytesOf(tick);
  Write("imu.csv", kRestingImu);
  Write("t.npy", NpyFile("<i8", "3,", ticks));
  Write("p.npy", NpyBytes(fixes));
  Write("fixes.mat", MatFile(MatMatrix("t", 12, 3, 1, MatElement(12, ticks)) +
                             MatDoubles("p", fixes)));
  const auto load = [&](bool mat, const std::string& unit,
                        const std::string& scale) {
    std::string columns = ReplacedOnce(places, "T", mat ? "t" : "t.npy");
    columns = ReplacedOnce(ReplacedOnce(columns, "U", unit), "S", scale);
    for (int i = 0; i < 3; ++i) {
      columns = ReplacedOnce(columns, "P", mat ? "p" : "p.npy");
    }
    Write("config.yaml",
          "imu:\n  file: imu.csv\n  noise: {gyro: 0.2 deg/sqrt(h), accel: 70 "
          "ug/sqrt(Hz)}\naiding:\n  gnss: {type: position, sigma: 1 m, file: " +
              std::string(mat ? "fixes.mat, format: mat" : "., format: npy") +
              ", columns: {" + columns + "}}\n");
  };
  for (const bool mat : {false, true}) {
    load(mat, "min", "1");
    ASSERT_EQ(LoadError(), "");
    EXPECT_EQ(Load().streams[0].measurements[1].t, 60.0);
    EXPECT_EQ(Load().streams[0].measurements[2].t, 300.0);
    load(mat, "s", "0.003");
    EXPECT_EQ(Load().streams[0].measurements[1].t, 0.003);
    EXPECT_EQ(Load().streams[0].measurements[2].t, 0.015);
    load(mat, "s", "-1");
    EXPECT_NE(LoadError().find("columns.t"), std::string::npos) << LoadError();
  }
}

TEST_F(ArrayFormats, MatlabFilesOfVersionFourInBothOrdersOfBytes) {
  Write("imu.csv", kRestingImu);
  for (const bool big : {false, true}) {
    const auto number = [&](auto value) {
      std::string bytes = BytesOf(value);
      if (big) std::reverse(bytes.begin(), bytes.end());
      return bytes;
    };
    std::string bytes;
    for (const std::int32_t word : {big ? 1000 : 0, 2, 4, 0, 4}) {
      bytes += number(word);
    }
    bytes += std::string("fix\0", 4);
    for (const double v : {0.0, 0.02, 48.0, 48.5, 11.0, 11.5, 500.0, 501.0}) {
      bytes += number(v);
    }
    Write("fixes.mat", bytes);
    Write("config.yaml",
          "imu:\n  file: imu.csv\n  noise: {gyro: 0.2 deg/sqrt(h), accel: 70 "
          "ug/sqrt(Hz)}\naiding:\n  gnss: {type: position, sigma: 1 m, file: "
          "fixes.mat, format: mat, columns: {t: 'fix:1 [s]', lat: 'fix:2 "
          "[deg]', lon: 'fix:3 [deg]', h: 'fix:4 [m]'}}\n");
    const Dataset data = Load();
    EXPECT_EQ(data.streams[0].measurements[1].t, 0.02);
    const auto fix =
        std::get<PositionFix>(data.streams[0].measurements[1].model);
    EXPECT_NEAR(GeodeticFromEcef(fix.p_e).longitude / kDegree, 11.5, 1e-10);
  }
}

class Rosbag : public SampleFolder {
 protected:
  static constexpr const char* kImu = "  file: drive.bag\n  format: rosbag\n";
  static constexpr const char* kFix =
      "aiding:\n  gnss: {type: position, file: drive.bag, format: rosbag}\n";
};

TEST_F(Rosbag, ImuAndNavSatFix) {
  const Dataset data =
      LoadSample("rosbag", std::string(kImu) + "  axes: [x, -y, -z]\n", kFix);
  ASSERT_EQ(data.imu.samples.size(), 5u);
  EXPECT_TRUE(data.imu.samples[3].gyro.isApprox(
      Eigen::Vector3d(0.3, -0.2, -0.3), 1e-15));
  EXPECT_EQ(data.imu.samples[3].accel, Eigen::Vector3d(0.4, -0.5, -9.8));
  EXPECT_NEAR(data.imu.samples[3].t, 0.03, 1e-9);
  // Midnight of 2017-01-01 UTC.
  EXPECT_EQ(*data.epoch_gps_ns / 1'000'000'000,
            ParseDateTime("2017-01-01 00:00:00 UTC")->seconds);
  ASSERT_EQ(data.streams[0].measurements.size(), 2u);
  const auto fix = std::get<PositionFix>(data.streams[0].measurements[0].model);
  EXPECT_NEAR(GeodeticFromEcef(fix.p_e).latitude / kDegree, 49.0, 1e-10);
  Eigen::Matrix3d R_n;
  R_n << 1, 0.25, 0, 0.25, 4, 0.16, 0, 0.16, 9;
  EXPECT_TRUE(fix.R_n.isApprox(R_n, 1e-14)) << fix.R_n;
  ASSERT_EQ(data.policies.size(), 1u);
  EXPECT_EQ(data.policies[0].action, "no fix");
}

TEST_F(Rosbag, CompressedChunksHoldTheSame) {
  const Dataset plain = LoadSample("rosbag", kImu, kFix);
  for (const std::string packed : {"drive_lz4.bag", "drive_bz2.bag"}) {
    const Dataset data =
        LoadSample("rosbag", ReplacedOnce(kImu, "drive.bag", packed),
                   ReplacedOnce(kFix, "drive.bag", packed));
    ASSERT_EQ(data.imu.samples.size(), plain.imu.samples.size());
    for (std::size_t i = 0; i < plain.imu.samples.size(); ++i) {
      EXPECT_EQ(data.imu.samples[i].t, plain.imu.samples[i].t);
      EXPECT_EQ(data.imu.samples[i].gyro, plain.imu.samples[i].gyro);
      EXPECT_EQ(data.imu.samples[i].accel, plain.imu.samples[i].accel);
    }
    EXPECT_EQ(data.streams[0].measurements.size(),
              plain.streams[0].measurements.size());
  }
}

TEST_F(Rosbag, MissingTopicAndDamage) {
  EXPECT_NE(SampleError("rosbag", std::string(kImu) + "  topic: /imu\n")
                .find("holds no topic /imu"),
            std::string::npos);
  EXPECT_NE(SampleError("", "  file: nmea/drive.nmea\n  format: rosbag\n")
                .find("cannot be read as a ROS 1 bag"),
            std::string::npos);
}

}  // namespace
}  // namespace hindsight
