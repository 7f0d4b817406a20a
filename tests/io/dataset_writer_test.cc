#include "io/write/dataset_writer.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/units.h"
#include "io/config/config.h"
#include "io/config/scenario_config.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

class DatasetWriter : public ::testing::Test {
 protected:
  DatasetWriter()
      : folder_(std::filesystem::temp_directory_path() /
                ("dataset_writer_test_" + std::to_string(getpid()))) {}
  ~DatasetWriter() override { std::filesystem::remove_all(folder_); }

  Dataset Load() const {
    return LoadDataset((folder_ / kDatasetConfigName).string());
  }

  std::filesystem::path folder_;
};

Scenario Rich() {
  Scenario s = FindScenario("car_drive");
  s.duration = 60.0;
  s.imu_rate_hz = 50.0;
  s.imu.noise.gyro_bias_walk = 1e-7;
  s.imu.noise.accel_bias_tau = 300.0;
  s.imu.noise.accel_bias_walk = 2e-5;
  AidingModel velocity = s.aiding.front();
  velocity.sensor.name = "doppler";
  velocity.sensor.kind = &VelocityKind();
  velocity.sensor.time_offset = 0.05;
  velocity.sensor.gate_probability = 0.999;
  velocity.sensor.time_offset_sigma = 0.1;
  velocity.draw_calibration = false;
  s.aiding.push_back(velocity);
  AidingModel height(HeightKind());
  height.sensor.name = "barometer";
  height.sigma.emplace().setConstant(0.5);
  s.aiding.push_back(height);
  s.stationary.enabled = true;
  s.withholdings = {{"gnss", 20.0, 5.0, 10.0}};
  return s;
}

void ExpectSameSensor(const Sensor& a, const Sensor& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.lever_arm_b, b.lever_arm_b);
  EXPECT_EQ(a.time_offset, b.time_offset);
  EXPECT_EQ(a.gate_probability, b.gate_probability);
  EXPECT_EQ(a.time_offset_sigma, b.time_offset_sigma);
}

void ExpectSameModel(const MeasurementModel& a, const MeasurementModel& b) {
  ASSERT_EQ(a.index(), b.index());
  if (const auto* x = std::get_if<PositionFix>(&a)) {
    const auto& y = std::get<PositionFix>(b);
    EXPECT_LT((x->p_e - y.p_e).norm(), 1e-6);
    EXPECT_LT((x->R_n - y.R_n).norm(), 1e-12);
  } else if (const auto* v = std::get_if<VelocityFix>(&a)) {
    const auto& y = std::get<VelocityFix>(b);
    EXPECT_LT((v->v_n - y.v_n).norm(), 2e-8);
    EXPECT_LT((v->R_n - y.R_n).norm(), 1e-12);
  } else {
    const auto& h = std::get<HeightFix>(a);
    const auto& y = std::get<HeightFix>(b);
    EXPECT_NEAR(h.height, y.height, 1e-6);
    EXPECT_NEAR(h.sigma, y.sigma, 1e-12);
  }
}

TEST_F(DatasetWriter, LoadingGivesBackWhatWasWritten) {
  const Dataset written = Simulate(Rich(), 5);
  WriteDataset(written, folder_.string());
  const Dataset read = Load();

  EXPECT_EQ(read.imu.kind, written.imu.kind);
  ASSERT_EQ(read.imu.samples.size(), written.imu.samples.size());
  // Of the first sample only the time is written, to a millionth of an
  // interval.
  EXPECT_NEAR(read.imu.t_begin(), written.imu.t_begin(), 1e-7);
  for (std::size_t k = 1; k < read.imu.samples.size(); ++k) {
    const ImuSample& a = read.imu.samples[k];
    const ImuSample& b = written.imu.samples[k];
    EXPECT_NEAR(a.t, b.t, 1e-9);
    EXPECT_LT((a.gyro - b.gyro).norm(), 1e-11 * b.gyro.norm());
    EXPECT_LT((a.accel - b.accel).norm(), 1e-11 * b.accel.norm());
  }
  const auto close = [](double a, double b) { return std::abs(a / b - 1.0); };
  EXPECT_LT(close(read.imu.noise.gyro_noise_density,
                  written.imu.noise.gyro_noise_density),
            1e-10);
  EXPECT_LT(close(read.imu.noise.accel_noise_density,
                  written.imu.noise.accel_noise_density),
            1e-10);
  EXPECT_LT(
      close(read.imu.noise.gyro_bias_walk, written.imu.noise.gyro_bias_walk),
      1e-10);
  EXPECT_LT(
      close(read.imu.noise.accel_bias_walk, written.imu.noise.accel_bias_walk),
      1e-10);
  EXPECT_EQ(read.imu.noise.accel_bias_tau, 300.0);

  ASSERT_EQ(read.streams.size(), written.streams.size());
  for (std::size_t s = 0; s < read.streams.size(); ++s) {
    ExpectSameSensor(read.streams[s].sensor, written.streams[s].sensor);
    const auto& a = read.streams[s].measurements;
    const auto& b = written.streams[s].measurements;
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
      EXPECT_NEAR(a[k].t, b[k].t, 1e-9);
      EXPECT_EQ(a[k].withheld, b[k].withheld);
      EXPECT_EQ(a[k].sensor, b[k].sensor);
      ExpectSameModel(a[k].model, b[k].model);
    }
  }
  EXPECT_EQ(read.outages.size(), 3U);
}

TEST_F(DatasetWriter, LoadingGivesBackTruthAndInitialValues) {
  const Dataset written = Simulate(Rich(), 5);
  WriteDataset(written, folder_.string());
  const Dataset read = Load();
  ASSERT_EQ(read.truth.size(), written.truth.size());
  for (std::size_t k = 0; k < read.truth.size(); ++k) {
    EXPECT_NEAR(read.truth[k].t, written.truth[k].t, 1e-9);
    EXPECT_LT((*read.truth[k].p_e - *written.truth[k].p_e).norm(), 2e-7);
    EXPECT_LT((*read.truth[k].v_n - *written.truth[k].v_n).norm(), 2e-8);
    EXPECT_LT(read.truth[k].q_nb->angularDistance(*written.truth[k].q_nb),
              1e-7);
  }
  EXPECT_LT((EcefFromGeodetic(*read.initial.position) -
             EcefFromGeodetic(*written.initial.position))
                .norm(),
            1e-6);
  EXPECT_LT((*read.initial.v_n - *written.initial.v_n).norm(), 1e-10);
  EXPECT_LT((*read.initial.euler - *written.initial.euler).norm(), 1e-10);
  EXPECT_LT(
      (*read.initial.attitude_sigma - *written.initial.attitude_sigma).norm(),
      1e-10);
  EXPECT_LT(
      (*read.initial.gyro_bias_sigma - *written.initial.gyro_bias_sigma).norm(),
      1e-15);
  EXPECT_TRUE(read.stationary.enabled);
  EXPECT_EQ(read.stationary.window, written.stationary.window);
}

TEST_F(DatasetWriter, NamesThatYamlWouldReadOtherwiseAreKept) {
  Scenario scenario = Rich();
  for (const char* name : {"drive: east", "drive #2", "[drive", "- drive"}) {
    scenario.name = name;
    WriteDataset(Simulate(scenario, 5), folder_.string());
    EXPECT_EQ(Load().name, name);
    std::filesystem::remove_all(folder_);
  }
}

TEST_F(DatasetWriter, StreamedSimulationWritesTheSameFiles) {
  const std::string at_once = (folder_ / "at_once").string();
  const std::string streamed = (folder_ / "streamed").string();
  WriteDataset(Simulate(Rich(), 5), at_once);
  Simulation simulation(Rich(), 5);
  std::filesystem::create_directory(streamed);
  WriteDataset(&simulation,
               [&](const std::string& name) { return streamed + "/" + name; });
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(at_once)) {
    ++files;
    const auto content = [](const std::filesystem::path& path) {
      std::ifstream file(path, std::ios::binary);
      return std::string(std::istreambuf_iterator<char>(file), {});
    };
    EXPECT_EQ(content(entry.path()), content(std::filesystem::path(streamed) /
                                             entry.path().filename()))
        << entry.path();
  }
  EXPECT_EQ(files, 6);  // config, imu, truth and three aiding streams
}

TEST_F(DatasetWriter, EveryNamedScenarioLoads) {
  for (const std::string& name : ScenarioNames()) {
    Scenario scenario = FindScenario(name);
    scenario.duration = std::min(scenario.duration, 90.0);
    scenario.withholdings.clear();
    scenario.injections.clear();
    WriteDataset(Simulate(scenario, 1), folder_.string());
    EXPECT_EQ(Load().name, name);
  }
}

TEST_F(DatasetWriter, RefusesWhatTheFormatCannotHold) {
  Dataset dataset = Simulate(Rich(), 5);
  dataset.streams[0].measurements.Edit(3, [](Measurement& z) {
    auto& fix = std::get<PositionFix>(z.model);
    fix.R_n(0, 1) = fix.R_n(1, 0) = 1e-4;
  });
  EXPECT_THROW(WriteDataset(dataset, folder_.string()), InputError);
}

}  // namespace
}  // namespace hindsight
