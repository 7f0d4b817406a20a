#include <gmock/gmock.h>

#include <cmath>

#include "base/units.h"
#include "io/sample_folder.h"
#include "measurements/noise_kind.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr const char* kImuConfig =
    "imu:\n  file: imu.csv\n"
    "  noise: {gyro: 0.2 deg/sqrt(h), accel: 70 ug/sqrt(Hz)}\n";

class AidingTypes : public SampleFolder {
 protected:
  AidingTypes() { Write("imu.csv", kRestingImu); }
  void Aiding(const std::string& text) const {
    Write("config.yaml", std::string(kImuConfig) + "aiding:\n" + text);
  }
};

TEST_F(AidingTypes, NoiseModels) {
  Write("gnss.csv", "t[s],lat[deg],lon[deg],h[m]\n0.01,48,11,500\n");
  Write("odo.csv", "t[s],speed[km/h]\n0.01,36\n");
  Aiding(
      "  gnss:\n    type: position\n    file: gnss.csv\n"
      "    noise: {model: gauss_markov, sigma: 50 cm, tau: 20 s}\n"
      "  odo:\n    type: odometer\n    file: odo.csv\n    form: forward\n"
      "    sigma: 0.1 m/s\n    noise: {model: mixture, outliers: 10 %}\n");
  const Dataset data = Load();
  const Sensor& gnss = data.streams[0].sensor;
  EXPECT_EQ(gnss.noise.kind, &GaussMarkovNoise());
  EXPECT_DOUBLE_EQ(gnss.noise.sigma, 0.5);
  EXPECT_DOUBLE_EQ(gnss.noise.tau, 20.0);
  EXPECT_DOUBLE_EQ(gnss.noise.white_sigma, 0.05);
  const RobustLoss& loss = data.streams[1].sensor.loss;
  EXPECT_EQ(loss.kind, RobustLoss::Kind::kMixture);
  EXPECT_DOUBLE_EQ(loss.outlier_share, 0.1);
  EXPECT_DOUBLE_EQ(loss.outlier_ratio, 20.0);
  EXPECT_DOUBLE_EQ(loss.scale, 1.0);
}

TEST_F(AidingTypes, OdometerWithCalibration) {
  Write("odo.csv", "t[s],speed[km/h]\n0.01,36\n0.03,-18\n");
  Aiding(
      "  odo:\n    type: odometer\n    file: odo.csv\n"
      "    sigma: [0.1, 0.2, 0.3 m/s]\n    scale: -0.8 %\n"
      "    lever_arm: [-1, 0, 0.5 m]\n    mounting: [0, 0, 90 deg]\n"
      "    estimate: {scale: 2 %, mounting: 3 deg, lever_arm: 0.1 m, "
      "time_offset: 20 ms}\n"
      "    loss: {kind: tukey, scale: 4.6}\n");
  const Dataset data = Load();
  const Sensor& sensor = data.streams[0].sensor;
  EXPECT_EQ(sensor.kind, &OdometerKind());
  EXPECT_DOUBLE_EQ(sensor.scale, -0.008);
  EXPECT_DOUBLE_EQ(*sensor.scale_sigma, 0.02);
  EXPECT_DOUBLE_EQ(sensor.mounting_sigma->z(), 3.0 * kDegree);
  EXPECT_DOUBLE_EQ(*sensor.time_offset_sigma, 0.02);
  EXPECT_EQ(sensor.loss.kind, RobustLoss::Kind::kTukey);
  EXPECT_EQ(sensor.loss.scale, 4.6);
  // Vehicle = Rz(90 deg) body: what is forward in the body is on the right.
  EXPECT_TRUE((sensor.q_sb * Eigen::Vector3d::UnitX())
                  .isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  const auto z = std::get<Odometer>(data.streams[0].measurements[1].model);
  EXPECT_DOUBLE_EQ(z.speed, -5.0);
  EXPECT_EQ(z.form, Odometer::Form::kThreeAxis);
  EXPECT_EQ(z.sigma, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(z.side_down, Eigen::Vector2d::Zero());
}

TEST_F(AidingTypes, OdometerMayMeasureThreeAxes) {
  Write("dvl.csv", "t[s],speed[m/s],side[m/s],down[m/s]\n0.01,1,2,3\n");
  Aiding("  dvl: {type: odometer, file: dvl.csv, sigma: 0.02 m/s}\n");
  const auto z = std::get<Odometer>(Load().streams[0].measurements[0].model);
  EXPECT_EQ(z.side_down, Eigen::Vector2d(2, 3));
  EXPECT_EQ(z.sigma, Eigen::Vector3d::Constant(0.02));
}

TEST_F(AidingTypes, MagnetometerInBodyAxesWithItsSurroundings) {
  Write("mag.csv", "t[s],mag_x[mG],mag_y[mG],mag_z[mG]\n0.01,200,10,-400\n");
  Aiding(
      "  mag:\n    type: magnetometer\n    file: mag.csv\n"
      "    form: vector\n    sigma: 300 nT\n    axes: [y, x, -z]\n"
      "    horizontal: 20 uT\n    down: 44 uT\n    declination: 3 deg\n"
      "    hard_iron: [1, 2, 3 uT]\n"
      "    estimate: {hard_iron: 2 uT, declination: 1 deg, disturbance: 5 uT, "
      "disturbance_tau: 4 s}\n");
  const Dataset data = Load();
  const MagneticSurroundings& magnetic = data.streams[0].sensor.magnetic;
  EXPECT_DOUBLE_EQ(magnetic.horizontal, 20.0);
  EXPECT_DOUBLE_EQ(magnetic.down, 44.0);
  EXPECT_DOUBLE_EQ(magnetic.declination, 3.0 * kDegree);
  EXPECT_TRUE(magnetic.hard_iron_b.isApprox(Eigen::Vector3d(1, 2, 3), 1e-12));
  EXPECT_DOUBLE_EQ(magnetic.hard_iron_sigma->y(), 2.0);
  EXPECT_DOUBLE_EQ(*magnetic.declination_sigma, 1.0 * kDegree);
  EXPECT_DOUBLE_EQ(*magnetic.disturbance_sigma, 5.0);
  EXPECT_DOUBLE_EQ(magnetic.disturbance_tau, 4.0);
  const auto z = std::get<MagneticField>(data.streams[0].measurements[0].model);
  EXPECT_TRUE(z.field_b.isApprox(Eigen::Vector3d(1.0, 20.0, 40.0), 1e-12));
  EXPECT_DOUBLE_EQ(z.sigma, 0.3);
  EXPECT_EQ(z.form, MagneticField::Form::kVector);
}

TEST_F(AidingTypes, MagneticVectorNeedsTheField) {
  Write("mag.csv", "t[s],mag_x[uT],mag_y[uT],mag_z[uT]\n0.01,20,1,40\n");
  Aiding(
      "  mag: {type: magnetometer, file: mag.csv, form: vector, sigma: 1 "
      "uT}\n");
  EXPECT_NE(LoadError().find("horizontal"), std::string::npos);
}

TEST_F(AidingTypes, ObGinsOdometerStandsInColumnEight) {
  std::string imu;
  for (int i = 1; i < 4; ++i) {
    imu += std::to_string(0.01 * i) + " 0 0 0 0 0 -0.098 " + std::to_string(i) +
           "\n";
  }
  Write("imu.txt", imu);
  Write("config.yaml",
        ReplacedOnce(kImuConfig, "imu.csv", "imu.txt\n  format: kf_gins") +
            std::string("aiding:\n  odo: {type: odometer, file: imu.txt, "
                        "format: kf_gins, form: forward, sigma: 0.1 m/s}\n"));
  const Dataset data = Load();
  ASSERT_EQ(data.imu.samples.size(), 1u + 3u);
  const auto z = std::get<Odometer>(data.streams[0].measurements[2].model);
  EXPECT_EQ(z.speed, 3.0);
  EXPECT_EQ(z.form, Odometer::Form::kForward);
}

TEST_F(AidingTypes, TheConstraintIsGeneratedOverTheImusRecord) {
  Aiding(
      "  wheels: {type: non_holonomic, rate: 100 Hz, sigma: [0.1, 0.2 m/s], "
      "estimate: {mounting: 5 deg}}\n");
  const Dataset data = Load();
  ASSERT_EQ(data.streams[0].measurements.size(), 5u);
  EXPECT_NEAR(data.streams[0].measurements[4].t, 0.04, 1e-12);
  const auto z = std::get<Odometer>(data.streams[0].measurements[4].model);
  EXPECT_EQ(z.form, Odometer::Form::kNonHolonomic);
  EXPECT_EQ(z.sigma.tail<2>(), Eigen::Vector2d(0.1, 0.2));
  EXPECT_DOUBLE_EQ(data.streams[0].sensor.mounting_sigma->x(), 5 * kDegree);
}

TEST_F(AidingTypes, RowsThatAreFlaggedMeasureZeroVelocity) {
  Write("flags.csv", "t,stance\n0.005,1\n0.01,0\n0.015,1\n");
  Aiding(
      "  stance:\n    type: zero_velocity\n    file: flags.csv\n"
      "    format: columns\n"
      "    columns: {t: \"t [s]\", zero_velocity: \"stance [1]\"}\n"
      "    sigma: 20 cm/s\n");
  const Dataset data = Load();
  EXPECT_EQ(data.streams[0].sensor.kind, &ZeroVelocityKind());
  const auto& measurements = data.streams[0].measurements;
  ASSERT_EQ(measurements.size(), 2u);
  EXPECT_DOUBLE_EQ(measurements[1].t, 0.015);
  // The two rows of one stance share their error.
  EXPECT_DOUBLE_EQ(std::get<ZeroVelocity>(measurements[1].model).sigma,
                   0.2 * std::sqrt(2.0));
  ASSERT_EQ(data.policies.size(), 1u);
  EXPECT_EQ(data.policies[0].action, "row without the flag");
  EXPECT_EQ(data.policies[0].count, 1);
}

TEST_F(AidingTypes, AFlagIsOneOrZeroAndItsSigmaGiven) {
  Write("flags.csv", "t[s],zero_velocity[1]\n0.005,1\n0.01,2\n");
  Aiding("  flag: {type: zero_velocity, file: flags.csv, sigma: 1 cm/s}\n");
  EXPECT_THAT(LoadError(),
              ::testing::HasSubstr("zero_velocity is 2; expected 1 or 0"));
  Aiding("  flag: {type: zero_velocity, file: flags.csv}\n");
  EXPECT_THAT(LoadError(), ::testing::HasSubstr("sigma"));
  Aiding(
      "  flag: {type: zero_velocity, file: flags.csv, sigma: 1 cm/s, "
      "lever_arm: [1, 0, 0 m]}\n");
  EXPECT_THAT(LoadError(), ::testing::HasSubstr("lever_arm"));
}

TEST_F(AidingTypes, IncrementsAreDifferencesOfACount) {
  Write("ticks.csv", "t[s],distance[m]\n0.01,100\n0.02,100.5\n0.04,100.25\n");
  Aiding(
      "  wheel: {type: odometer, form: increments, file: ticks.csv, sigma: 5 "
      "mm, count_sigma: 2 mm, scale: 1 %, time_offset: 0.1 ms}\n");
  const Dataset data = Load();
  EXPECT_DOUBLE_EQ(data.streams[0].sensor.count_sigma, 0.002);
  EXPECT_DOUBLE_EQ(data.streams[0].sensor.scale, 0.01);
  const auto& measurements = data.streams[0].measurements;
  // The first count only begins the first increment.
  ASSERT_EQ(measurements.size(), 2u);
  const auto first = std::get<Odometer>(measurements[0].model);
  EXPECT_EQ(first.form, Odometer::Form::kIncrements);
  EXPECT_DOUBLE_EQ(first.distance, 0.5);
  EXPECT_DOUBLE_EQ(first.sigma.x(), 0.005);
  EXPECT_NEAR(first.t_from, 0.01, 1e-12);
  EXPECT_NEAR(measurements[0].t, 0.02, 1e-12);
  const auto second = std::get<Odometer>(measurements[1].model);
  EXPECT_DOUBLE_EQ(second.distance, -0.25);
  EXPECT_EQ(second.t_from, measurements[0].t);
}

TEST_F(AidingTypes, IncrementsNeedACount) {
  Write("odo.csv", "t[s],speed[m/s]\n0.01,1\n0.03,2\n");
  Aiding(
      "  wheel: {type: odometer, form: increments, file: odo.csv, sigma: 5 "
      "mm}\n");
  EXPECT_THAT(LoadError(), ::testing::HasSubstr("no column distance"));
}

TEST_F(AidingTypes, MountingMayBeUnknownAndTheVehicleLevelOnAverage) {
  Aiding(
      "  wheels: {type: non_holonomic, rate: 100 Hz, sigma: [0.1, 0.2 m/s], "
      "mounting: unknown, level_on_average: 0.5 deg}\n");
  ResolvedConfig resolved;
  const Dataset data = Load(&resolved);
  EXPECT_TRUE(data.streams[0].sensor.mounting_unknown);
  EXPECT_DOUBLE_EQ(data.streams[0].sensor.mounting_sigma->x(), 10 * kDegree);
  ASSERT_EQ(data.streams.size(), 2u);
  const AidingStream& level = data.streams[1];
  EXPECT_EQ(level.sensor.name, "wheels_level");
  EXPECT_EQ(level.sensor.vehicle, 0);
  // So many of them that their mean has the sigma asked for.
  const auto z = std::get<VehicleLevel>(level.measurements[0].model);
  EXPECT_NEAR(z.sigma / std::sqrt(level.measurements.size()), 0.5 * kDegree,
              1e-12);
  EXPECT_EQ(level.measurements[0].sensor, 1);
  // What was resolved loads the same.
  Write("config.yaml", resolved.yaml);
  EXPECT_TRUE(Load().streams[0].sensor.mounting_unknown);
}

TEST_F(AidingTypes, StreamsCanBeLeftOut) {
  Write("odo.csv", "t[s],speed[m/s]\n0.01,1\n0.03,2\n");
  Aiding(
      "  wheels: {type: non_holonomic, rate: 100 Hz, sigma: [0.1, 0.2 m/s], "
      "level_on_average: 1 deg}\n"
      "  odo: {type: odometer, file: odo.csv, sigma: 0.1 m/s}\n");
  LoadOptions options;
  options.without = {"wheels"};
  const Dataset data = LoadDataset(Path("config.yaml"), options);
  ASSERT_EQ(data.streams.size(), 1u);
  EXPECT_EQ(data.streams[0].sensor.name, "odo");
  EXPECT_EQ(data.streams[0].measurements[0].sensor, 0);
  options.without = {"wheel"};
  EXPECT_THROW(LoadDataset(Path("config.yaml"), options), InputError);
}

TEST_F(AidingTypes, CourseBelowTheThresholdIsNotUsed) {
  Write("rmc.csv",
        "t[s],speed[m/s],course[deg]\n0.01,0.5,30\n0.02,2,40\n0.03,2,\n");
  Aiding(
      "  rmc: {type: speed_course, file: rmc.csv, sigma: 0.1 m/s, "
      "course_sigma: 1 deg, course_above: 1 m/s}\n");
  const Dataset data = Load();
  const auto at = [&](std::size_t i) {
    return std::get<SpeedCourse>(data.streams[0].measurements[i].model);
  };
  EXPECT_FALSE(at(0).has_course);
  EXPECT_TRUE(at(1).has_course);
  EXPECT_DOUBLE_EQ(at(1).course, 40 * kDegree);
  EXPECT_DOUBLE_EQ(at(1).sigma_course, kDegree);
  EXPECT_FALSE(at(2).has_course);
}

TEST_F(AidingTypes, EveryThinsOutDespiteJitter) {
  std::string text = "t[s],h[m],sigma_h[m]\n";
  for (int i = 0; i < 40; ++i) {
    text += std::to_string(0.001 * i + (i % 2 == 0 ? 1e-4 : 0.0)) + ",1,1\n";
  }
  Write("h.csv", text);
  Aiding("  h: {type: height, file: h.csv, every: 10 ms}\n");
  const Dataset data = Load();
  ASSERT_EQ(data.streams[0].measurements.size(), 4u);
  EXPECT_NEAR(data.streams[0].measurements[3].t, 0.0301, 1e-9);
  EXPECT_EQ(data.policies[0].action, "thinned out");
  EXPECT_EQ(data.policies[0].count, 36);
}

TEST_F(AidingTypes, ScaleFactorsOfTheImuMayBeEstimated) {
  Write("config.yaml", std::string(kImuConfig) +
                           "  estimate: {gyro_scale: 3 %, accel_scale: "
                           "[1000, 2000, 3000 ppm]}\n");
  const Dataset data = Load();
  EXPECT_EQ(*data.gyro_scale_sigma, Eigen::Vector3d::Constant(0.03));
  EXPECT_TRUE(data.accel_scale_sigma->isApprox(
      Eigen::Vector3d(1e-3, 2e-3, 3e-3), 1e-14));
}

TEST_F(AidingTypes, MistakesNameLineAndKey) {
  Write("odo.csv", "t[s],speed[m/s]\n0.01,1\n");
  struct Case {
    const char* aiding;
    const char* says;
  };
  const Case cases[] = {
      {"  odo: {type: odometer, file: odo.csv}\n", "aiding.odo.sigma"},
      {"  odo: {type: odometer, file: odo.csv, sigma: 0 m/s}\n", "zero"},
      {"  odo: {type: odometer, file: odo.csv, sigma: 1 m/s, form: sideways}\n",
       "forward"},
      {"  nhc: {type: non_holonomic, sigma: [1, 1 m/s]}\n", "rate"},
      {"  nhc: {type: non_holonomic, rate: 1 Hz, sigma: 1 m/s}\n", "[ ]"},
      {"  nhc: {type: non_holonomic, rate: 1 Hz, sigma: [1, 1 m/s], file: "
       "odo.csv}\n",
       "unknown key"},
      {"  odo: {type: odometer, file: odo.csv, sigma: 1 m/s, loss: {kind: "
       "l2}}\n",
       "huber"},
      {"  odo: {type: odometer, file: odo.csv, sigma: 1 m/s, format: euroc}\n",
       "no such stream"},
      {"  odo: {type: odometer, file: odo.csv, sigma: 1 m/s, noise: {model: "
       "gauss_markov, sigma: 1 m, tau: 1 s}}\n",
       "position, velocity, height and depth"},
      {"  odo: {type: odometer, file: odo.csv, sigma: 1 m/s, noise: {model: "
       "mixture, ratio: 0.5}}\n",
       "above 1"},
      {"  odo: {type: odometer, file: odo.csv, sigma: 1 m/s, loss: {kind: "
       "cauchy}, noise: {model: mixture}}\n",
       "does not go with a loss"},
      {"  c: {type: speed_course, file: odo.csv, sigma: 1 m/s}\n",
       "course_sigma"},
      {"  h: {type: height, file: odo.csv, sigma: 5 m, noise: {model: "
       "gauss_markov, sigma: 1 m, tau: 1 s}}\n",
       "aiding.h.sigma: does not go with noise of model gauss_markov"},
      {"  h: {type: height, file: odo.csv, sigma_scale: 7, noise: {model: "
       "gauss_markov, sigma: 1 m, tau: 1 s}}\n",
       "aiding.h.sigma_scale: does not go with noise of model gauss_markov"},
      {"  h: {type: height, file: odo.csv, noise: {model: gauss_markov, "
       "sigma: 1e-30 m, tau: 1 s}}\n",
       "aiding.h.noise.sigma: expected at least 1e-6 m"},
      {"  h: {type: height, file: odo.csv, noise: {model: gauss_markov, "
       "sigma: 1 m, tau: 1 s, white: 1e-9 m}}\n",
       "aiding.h.noise.white: expected at least 1e-6 m"},
  };
  for (const Case& c : cases) {
    Aiding(c.aiding);
    const std::string error = LoadError();
    EXPECT_TRUE(error.starts_with("config.yaml:")) << error;
    EXPECT_NE(error.find(c.says), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace hindsight
