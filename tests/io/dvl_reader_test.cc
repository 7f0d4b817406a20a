#include "base/units.h"
#include "io/sample_folder.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr const char* kDvlImuConfig =
    "imu:\n  file: imu.csv\n"
    "  noise: {gyro: 0.2 deg/sqrt(h), accel: 70 ug/sqrt(Hz)}\n";

class DvlReader : public SampleFolder {
 protected:
  DvlReader() { Write("imu.csv", kRestingImu); }
  void Aiding(const std::string& text) const {
    Write("config.yaml", std::string(kDvlImuConfig) + "aiding:\n" + text);
  }
  static Dvl At(const Dataset& data, std::size_t i) {
    return std::get<Dvl>(data.streams[0].measurements[i].model);
  }
};

TEST_F(DvlReader, ThreeAxesWithCalibration) {
  Write("dvl.csv", "t[s],v_x[m/s],v_y[m/s],v_z[km/h]\n0.01,1,2,3.6\n");
  Aiding(
      "  log:\n    type: dvl\n    file: dvl.csv\n"
      "    sigma: [0.01, 0.02, 0.03 m/s]\n    scale: 1 %\n"
      "    mounting: [0, 0, 90 deg]\n    lever_arm: [1, 0, 0.5 m]\n"
      "    estimate: {scale: 0.3 %, mounting: 0.2 deg, lever_arm: 0.1 m, "
      "time_offset: 20 ms}\n");
  const Dataset data = Load();
  const Sensor& sensor = data.streams[0].sensor;
  EXPECT_EQ(sensor.kind, &DvlKind());
  EXPECT_DOUBLE_EQ(sensor.scale, 0.01);
  EXPECT_DOUBLE_EQ(*sensor.scale_sigma, 0.003);
  EXPECT_DOUBLE_EQ(sensor.mounting_sigma->x(), 0.2 * kDegree);
  EXPECT_TRUE((sensor.q_sb * Eigen::Vector3d::UnitX())
                  .isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  const Dvl& z = At(data, 0);
  EXPECT_EQ(z.form, Dvl::Form::kThreeAxis);
  EXPECT_EQ(z.speed.head<3>(), Eigen::Vector3d(1, 2, 1));
  EXPECT_EQ(z.sigma.head<3>(), Eigen::Vector3d(0.01, 0.02, 0.03));
  EXPECT_FALSE(z.water);
}

TEST_F(DvlReader, BeamsDropOutByFlagAndByAbsence) {
  Write("dvl.csv",
        "t[s],beam_1[m/s],beam_2[m/s],beam_3[m/s],beam_4[m/s],valid_1[1],"
        "valid_2[1],valid_3[1],valid_4[1]\n"
        "0.01,0.1,0.2,0.3,0.4,1,1,1,1\n"
        "0.02,0.1,0.2,,nan,1,0,1,1\n"
        "0.03,,,,,0,0,0,0\n");
  Aiding(
      "  log: {type: dvl, form: beams, file: dvl.csv, sigma: 0.02 m/s, "
      "beam_angle: 25 deg, beam_azimuth: 30 deg}\n");
  const Dataset data = Load();
  ASSERT_EQ(data.streams[0].measurements.size(), 2u);
  EXPECT_EQ(At(data, 0).rows(), 4);
  EXPECT_DOUBLE_EQ(At(data, 0).beam_angle, 25.0 * kDegree);
  EXPECT_DOUBLE_EQ(At(data, 0).beam_azimuth, 30.0 * kDegree);
  EXPECT_EQ(At(data, 0).speed, Eigen::Vector4d(0.1, 0.2, 0.3, 0.4));
  const std::array<bool, 4> first_alone = {true, false, false, false};
  EXPECT_EQ(At(data, 1).valid, first_alone);
  ASSERT_FALSE(data.policies.empty());
  EXPECT_EQ(data.policies.back().action, "row without a valid beam");
  EXPECT_EQ(data.policies.back().count, 1);
}

TEST_F(DvlReader, WaterTrackBringsItsCurrent) {
  Write(
      "dvl.csv",
      "t[s],v_x[m/s],v_y[m/s],v_z[m/s],water[1]\n0.01,1,2,3,0\n0.02,1,2,3,1\n");
  const std::string log = "  log: {type: dvl, file: dvl.csv, sigma: 0.02 m/s";
  Aiding(log + ", current: {sigma: 0.3 m/s, length: 500 m}}\n");
  const Dataset data = Load();
  EXPECT_FALSE(At(data, 0).water);
  EXPECT_TRUE(At(data, 1).water);
  EXPECT_DOUBLE_EQ(*data.streams[0].sensor.current_sigma, 0.3);
  EXPECT_DOUBLE_EQ(data.streams[0].sensor.current_length, 500.0);
  Aiding(log + "}\n");
  EXPECT_EQ(LoadError().find("dvl.csv:3: "), 0u) << LoadError();
}

TEST_F(DvlReader, DepthIsHeightBelowTheSurface) {
  Write("depth.csv", "t[s],depth[m],sigma_depth[m]\n0.01,12.5,0.1\n");
  Aiding(
      "  depth: {type: depth, file: depth.csv, surface: 30 m, "
      "estimate: {offset: 0.5 m}}\n");
  const Dataset data = Load();
  const auto z = std::get<HeightFix>(data.streams[0].measurements[0].model);
  EXPECT_DOUBLE_EQ(z.height, 17.5);
  EXPECT_DOUBLE_EQ(z.sigma, 0.1);
  EXPECT_DOUBLE_EQ(*data.streams[0].sensor.offset_sigma, 0.5);
}

TEST_F(DvlReader, RangeAndBearingToATransponder) {
  Write("lbl.csv",
        "t[s],range[m],azimuth[deg],depression[deg]\n0.01,99,90,30\n");
  const std::string lbl =
      "  lbl: {type: acoustic, file: lbl.csv, transponder: [35 deg, 129 deg, "
      "-100 m], ";
  Aiding(lbl + "sigma: 0.5 m, estimate: {scale: 0.5 %}}\n");
  Dataset data = Load();
  const auto range =
      std::get<AcousticFix>(data.streams[0].measurements[0].model);
  EXPECT_EQ(range.rows(), 1);
  EXPECT_DOUBLE_EQ(range.range, 99.0);
  Aiding(lbl + "bearing_sigma: 1 deg}\n");
  data = Load();
  const auto bearing =
      std::get<AcousticFix>(data.streams[0].measurements[0].model);
  EXPECT_EQ(bearing.rows(), 2);
  EXPECT_DOUBLE_EQ(bearing.azimuth, 0.5 * kPi);
  EXPECT_LT(
      (bearing.p_t_e - EcefFromGeodetic({35 * kDegree, 129 * kDegree, -100.0}))
          .norm(),
      1e-6);
}

TEST_F(DvlReader, FlagsAreOneOrZero) {
  const std::string head =
      "t[s],beam_1[m/s],beam_2[m/s],beam_3[m/s],beam_4[m/s],valid_2[1],"
      "water[1]\n0.01,1,1,1,1,1,0\n0.02,1,1,1,1,";
  const std::string log =
      "  log: {type: dvl, form: beams, file: dvl.csv, sigma: 0.02 m/s, "
      "current: {sigma: 1 m/s}";
  Aiding(log + "}\n");
  for (const char* row : {"0.5,0", "2,0", "nan,0", "1,-1", "1,nan"}) {
    Write("dvl.csv", head + row + "\n");
    const std::string error = LoadError();
    EXPECT_EQ(error.find("dvl.csv:3: "), 0u) << error;
    EXPECT_NE(error.find("; expected 1 or 0"), std::string::npos) << error;
  }
  // Absent, if they may be: not received, over the bottom.
  Aiding(log + ", absent_values: true}\n");
  Write("dvl.csv", head + "nan,nan\n");
  const Dataset data = Load();
  EXPECT_EQ(At(data, 1).rows(), 3);
  EXPECT_FALSE(At(data, 1).water);
}

TEST_F(DvlReader, FlagsOfBeamsDoNotGoWithThreeAxes) {
  Write("dvl.csv",
        "t[s],v_x[m/s],v_y[m/s],v_z[m/s],valid_1[1]\n0.01,1,2,3,0\n");
  Aiding("  log: {type: dvl, file: dvl.csv, sigma: 0.02 m/s}\n");
  EXPECT_NE(LoadError().find("valid_1 goes with `form: beams`"),
            std::string::npos)
      << LoadError();
}

TEST_F(DvlReader, MistakesNameLineAndKey) {
  Write("dvl.csv", "t[s],v_x[m/s],v_y[m/s],v_z[m/s]\n0.01,1,2,3\n");
  struct Case {
    const char* aiding;
    const char* says;
  };
  const Case cases[] = {
      {"  d: {type: dvl, file: dvl.csv}\n", "aiding.d.sigma"},
      {"  d: {type: dvl, file: dvl.csv, sigma: 1 m/s, form: beams}\n",
       "beam_1"},
      {"  d: {type: dvl, file: dvl.csv, sigma: 1 m/s, track: water}\n",
       "current"},
      {"  d: {type: dvl, file: dvl.csv, sigma: 1 m/s, beam_angle: 30 deg}\n",
       "unknown key"},
      {"  d: {type: dvl, file: dvl.csv, sigma: 1 m/s, current: {sigma: 1 m/s, "
       "time: 1 s, length: 1 m}}\n",
       "time"},
      {"  d: {type: acoustic, file: dvl.csv, transponder: [0 deg, 0 deg, 0 "
       "m]}\n",
       "bearing_sigma"},
      {"  d: {type: acoustic, file: dvl.csv, sigma: 1 m}\n", "transponder"},
      {"  d: {type: depth, file: dvl.csv, sigma: 1 m}\n", "depth"},
      {"  d: {type: depth, file: dvl.csv, sigma: [1, 2, 3 m]}\n",
       "config.yaml:5: aiding.d.sigma: expected one value"},
      {"  d: {type: dvl, file: dvl.csv, sigma: 1 m/s, scale: -100 %}\n",
       "config.yaml:5: aiding.d.scale: expected more than -100 %"},
      {"  d: {type: dvl, file: dvl.csv, sigma: 1 m/s, mounting: [0, 0, 400 "
       "deg]}\n",
       "config.yaml:5: aiding.d.mounting: expected angles of -360 to 360 deg"},
  };
  for (const Case& c : cases) {
    Aiding(c.aiding);
    const std::string error = LoadError();
    EXPECT_NE(error.find(c.says), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace hindsight
