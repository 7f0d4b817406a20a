#include <cmath>

#include "base/units.h"
#include "io/recording_folder.h"

namespace hindsight {
namespace {

constexpr const char* kNoise =
    "  noise: {gyro: 0.2 deg/sqrt(h), accel: 70 ug/sqrt(Hz)}\n";

class ReaderFormats : public RecordingFolder {
 protected:
  void WriteConfig(const std::string& imu, const std::string& rest = "",
                   const std::string& top = "") const {
    Write("config.yaml", top + "imu:\n" + imu + kNoise + rest);
  }
};

TEST_F(ReaderFormats, KfGinsFilesOfOneSet) {
  Write("imu.txt",
        "456300.005  1e-6 2e-6 3e-6  0.001 0.002 -0.049\n"
        "456300.010  1e-6 2e-6 3e-6  0.001 0.002 -0.049\n"
        "456300.015  4e-6 5e-6 6e-6  0.001 0.002 -0.049\n");
  Write("gnss.txt",
        "456300.000  30.5 114.25 20.5  0.01 0.02 0.03\n"
        "456300.010  30.5 114.25 20.5  0.01 0.02 0.03\n");
  Write("truth.nav",
        "2017 456300.005  30.5 114.25 20.5  1 2 3  0.5 -0.5 90\n"
        "2017 456300.010  30.5 114.25 20.5  1 2 3  0.5 -0.5 90\n");
  WriteConfig("  file: imu.txt\n  format: kf_gins\n",
              "aiding:\n  gnss: {type: position, file: gnss.txt, "
              "format: kf_gins}\n"
              "truth: {file: truth.nav, format: kf_gins}\n");
  const Dataset data = Load();
  EXPECT_EQ(data.imu.kind, ImuStream::Kind::kIncrements);
  // The first row's interval begins 5 ms before its stamp.
  EXPECT_NEAR(data.imu.samples[0].t, 456300.0, 1e-7);
  EXPECT_DOUBLE_EQ(data.imu.samples[3].t, 456300.015);
  EXPECT_EQ(data.imu.samples[3].gyro, Eigen::Vector3d(4e-6, 5e-6, 6e-6));
  EXPECT_EQ(data.imu.samples[3].accel, Eigen::Vector3d(0.001, 0.002, -0.049));
  const auto fix = std::get<PositionFix>(data.streams[0].measurements[0].model);
  EXPECT_NEAR(GeodeticFromEcef(fix.p_e).longitude / kDegree, 114.25, 1e-10);
  EXPECT_DOUBLE_EQ(fix.R_n(1, 1), 4e-4);
  ASSERT_EQ(data.truth.size(), 2u);
  EXPECT_DOUBLE_EQ(data.truth[0].t, 456300.005);
  EXPECT_EQ(data.truth[0].v_n.value(), Eigen::Vector3d(1, 2, 3));
  const Eigen::Vector3d euler = EulerFromQuaternion(*data.truth[0].q_nb);
  EXPECT_NEAR(euler.z() / kDegree, 90.0, 1e-9);
  EXPECT_NEAR(euler.y() / kDegree, -0.5, 1e-9);
}

constexpr const char* kPos =
    "% program   : RTKLIB\n"
    "%  GPST  latitude(deg) longitude(deg) height(m)   Q  ns   sdn(m)   sde(m) "
    "  sdu(m)  sdne(m)  sdeu(m)  sdun(m) age(s)  ratio    vn(m/s)    ve(m/s)   "
    " vu(m/s)      sdvn     sdve     sdvu    sdvne    sdveu    sdvun\n"
    "2025/07/08 19:34:00.500 40 -105 1600 1 9 0.03 0.04 0.05 -0.02 0.01 0.015 "
    "0 0 1 2 3 0.1 0.1 0.2 0.05 0 0\n"
    "2025/07/08 19:34:01.000 40 -105 1600 2 9 0.03 0.04 0.05 0 0 0 "
    "0 0 0 0 0 0 0 0 0 0 0\n";
constexpr const char* kDatedImu =
    "0,0,0,0,0,0,-1\n250,0,0,0,0,0,-1\n500,0,0,0,0,0,-1\n";
constexpr const char* kDatedColumns =
    "  file: imu.txt\n  format: columns\n"
    "  columns: {t: '1 [ms]', gyro_x: '2 [deg/s]', gyro_y: '3 [deg/s]', "
    "gyro_z: '4 [deg/s]', accel_x: '5 [g]', accel_y: '6 [g]', "
    "accel_z: '7 [g]'}\n"
    "  time: {start: '2025-07-08 19:34:00.25 GPST', duration: 1 s}\n";

TEST_F(ReaderFormats, RtklibPosBecomesNorthEastDown) {
  Write("imu.txt", kDatedImu);
  Write("rover.pos", kPos);
  WriteConfig(kDatedColumns,
              "aiding:\n"
              "  pos: {type: position, file: rover.pos, format: rtklib_pos, "
              "accept_quality: [1]}\n"
              "  vel: {type: velocity, file: rover.pos, format: rtklib_pos}\n");
  const Dataset data = Load();
  // The stamps are stretched from 0.5 s to 1 s and start at :00.25; t = 0 is
  // the whole second before.
  EXPECT_DOUBLE_EQ(data.imu.samples[1].t, 0.75);
  EXPECT_DOUBLE_EQ(data.imu.samples[2].t, 1.25);
  ASSERT_EQ(data.streams[0].measurements.size(), 1u);
  EXPECT_DOUBLE_EQ(data.streams[0].measurements[0].t, 0.5);
  const Eigen::Matrix3d R =
      std::get<PositionFix>(data.streams[0].measurements[0].model).R_n;
  const auto fix = std::get<PositionFix>(data.streams[0].measurements[0].model);
  EXPECT_EQ(fix.quality, 1.0);
  EXPECT_EQ(fix.satellites, 9.0);
  EXPECT_DOUBLE_EQ(R(0, 1), -0.02 * 0.02);
  EXPECT_DOUBLE_EQ(R(1, 2), -0.01 * 0.01);
  EXPECT_DOUBLE_EQ(R(0, 2), -0.015 * 0.015);
  ASSERT_EQ(data.streams[1].measurements.size(), 1u);
  const auto v = std::get<VelocityFix>(data.streams[1].measurements[0].model);
  EXPECT_EQ(v.v_n, Eigen::Vector3d(1, 2, -3));
  EXPECT_DOUBLE_EQ(v.R_n(0, 1), 0.05 * 0.05);
  ASSERT_EQ(data.policies.size(), 2u);
  EXPECT_EQ(data.policies[0].action, "quality not accepted");
  EXPECT_EQ(data.policies[1].action, "velocity absent");
}

TEST_F(ReaderFormats, RtklibWeekAndUtcVariantsAreTheSameInstant) {
  Write("imu.txt", kDatedImu);
  // 2025-07-08 19:34:00.5 GPST is week 2374, 2 days and 70440.5 s.
  std::string week =
      ReplacedOnce(kPos, "2025/07/08 19:34:00.500", "2374 243240.500");
  week = ReplacedOnce(week, "2025/07/08 19:34:01.000", "2374 243241.000");
  std::string utc = ReplacedOnce(kPos, "GPST", "UTC");
  utc = ReplacedOnce(utc, "19:34:00.500", "19:33:42.500");
  utc = ReplacedOnce(utc, "19:34:01.000", "19:33:43.000");
  for (const std::string& text : {week, utc}) {
    Write("rover.pos", text);
    WriteConfig(kDatedColumns,
                "aiding:\n  pos: {type: position, file: rover.pos, "
                "format: rtklib_pos}\n");
    const Dataset data = Load();
    EXPECT_NEAR(data.streams[0].measurements[0].t, 0.5, 1e-9);
  }
}

TEST_F(ReaderFormats, CorrelationBeyondOneIsRefused) {
  Write("imu.txt", kDatedImu);
  Write("rover.pos", ReplacedOnce(kPos, "-0.02", "-0.04"));
  WriteConfig(kDatedColumns,
              "aiding:\n  pos: {type: position, file: rover.pos, "
              "format: rtklib_pos}\n");
  EXPECT_TRUE(LoadError().starts_with("rover.pos:3: the covariance"))
      << LoadError();
}

TEST_F(ReaderFormats, ColumnsByTitleWithSignScaleAndNanoseconds) {
  Write("imu.txt",
        "#timestamp first\n"
        "stamp [ns];wx;wy;wz;fx;fy;fz\n"
        "1403636579758555392;1;2;3;4;5;6\n"
        "1403636579763555584;1;2;3;4;5;6\n");
  WriteConfig(
      "  file: imu.txt\n  format: columns\n"
      "  columns:\n"
      "    t: stamp\n"
      "    gyro_x: wx [rad/s]\n    gyro_y: -wy [rad/s]\n"
      "    gyro_z: {column: wz, unit: mrad/s, scale: 2}\n"
      "    accel_x: fx [m/s^2]\n    accel_y: fy [m/s^2]\n"
      "    accel_z: fz [m/s^2]\n"
      "  time: {clock: unix}\n");
  const Dataset data = Load();
  EXPECT_TRUE(
      data.imu.samples[0].gyro.isApprox(Eigen::Vector3d(1, -2, 0.006), 1e-15));
  EXPECT_NEAR(data.imu.samples[1].t - data.imu.samples[0].t, 0.005000192,
              1e-12);
  // 16 leap seconds in 2014.
  EXPECT_EQ(data.epoch_gps_ns.value(),
            (1403636579LL - 315964800LL + 16LL) * 1'000'000'000LL);
}

TEST_F(ReaderFormats, RateReplacesStampsAndStartMovesIncrements) {
  Write("imu.txt", "9 1 2 3 4 5 6\n9 1 2 3 4 5 6\n2 1 2 3 4 5 6\n");
  WriteConfig(
      "  file: imu.txt\n  format: columns\n"
      "  columns: {dtheta_x: '2 [rad]', dtheta_y: '3 [rad]', "
      "dtheta_z: '4 [rad]', dvel_x: '5 [m/s]', dvel_y: '6 [m/s]', "
      "dvel_z: '7 [m/s]'}\n"
      "  time: {rate: 100 Hz, start: 5 s}\n  stamp: start\n");
  const Dataset data = Load();
  ASSERT_EQ(data.imu.samples.size(), 1u + 3u);
  EXPECT_NEAR(data.imu.samples[0].t, 5.0, 1e-12);
  EXPECT_NEAR(data.imu.samples[1].t, 5.01, 1e-12);
  EXPECT_NEAR(data.imu.samples[3].t, 5.03, 1e-12);
}

TEST_F(ReaderFormats, DatedAidingNeedsADatedImu) {
  Write("imu.txt", kDatedImu);
  Write("rover.pos", kPos);
  WriteConfig(
      ReplacedOnce(kDatedColumns, "'2025-07-08 19:34:00.25 GPST'", "0 s"),
      "aiding:\n  pos: {type: position, file: rover.pos, "
      "format: rtklib_pos}\n");
  EXPECT_NE(LoadError().find("`epoch`"), std::string::npos) << LoadError();
}

TEST_F(ReaderFormats, AbsentTruthNeedsItsPolicy) {
  Write("imu.txt", kDatedImu);
  Write("truth.csv",
        "t[s],lat[deg],lon[deg],h[m],roll[deg],pitch[deg],heading[deg]\n"
        "0.5,40,-105,1600,1,2,3\n0.75,,,,1,2,3\n1,40,-105,1600,nan,nan,nan\n");
  WriteConfig(kDatedColumns, "truth: {file: truth.csv}\n");
  EXPECT_TRUE(LoadError().starts_with("truth.csv:3: column 2 (lat)"))
      << LoadError();
  WriteConfig(kDatedColumns, "truth: {file: truth.csv, absent_values: true}\n");
  const Dataset data = Load();
  ASSERT_EQ(data.truth.size(), 3u);
  EXPECT_TRUE(data.truth[0].p_e && data.truth[0].q_nb && !data.truth[0].v_n);
  EXPECT_TRUE(!data.truth[1].p_e && data.truth[1].q_nb);
  EXPECT_TRUE(data.truth[2].p_e && !data.truth[2].q_nb);
  ASSERT_EQ(data.policies.size(), 1u);
  EXPECT_EQ(data.policies[0].count, 2);
}

}  // namespace
}  // namespace hindsight
