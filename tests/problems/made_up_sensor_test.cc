#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"
#include "dataset/checks.h"
#include "geometry/so3.h"
#include "io/config/config.h"
#include "io/config/config_help.h"
#include "io/config/scenario_config.h"
#include "io/write/dataset_writer.h"
#include "measurements/point_motion.h"
#include "measurements/sensor_kind.h"
#include "problems/method.h"
#include "problems/reconstruction.h"
#include "simulation/scenario.h"
#include "support/temporary_folder.h"

namespace hindsight {
namespace {

/// A variometer, which nothing but this file knows: (1 + k) times the velocity
/// upwards of its point, and a drift that comes and goes [m/s].
void EvaluateClimb(const GenericReading& z, const ModelContext& context,
                   LinearizedMeasurement* out) {
  const PointMotion motion = MotionOfSensor(context);
  const double scale =
      1.0 + Parameter1(context.layout, context.state, BlockKind::kScale,
                       context.sensor_index, context.sensor.scale);
  const Eigen::RowVector3d up_e = -motion.C_en.col(2).transpose();
  const double climb = up_e * motion.v_e;
  out->Resize(1, context.layout.dim());
  out->residual(0) = z.value(0) - scale * climb -
                     Parameter1(context.layout, context.state,
                                BlockKind::kOffset, context.sensor_index, 0.0);
  context.layout.AddColumns(BlockKind::kOffset, context.sensor_index,
                            Eigen::Matrix<double, 1, 1>(1.0), &out->H);
  out->R(0, 0) = z.sigma(0) * z.sigma(0);
  AddVelocityColumns(context, motion, scale * up_e, &out->H);
  // The vertical turns with the position.
  const Eigen::Vector3d v_n = motion.C_en.transpose() * motion.v_e;
  context.layout.AddColumns(
      BlockKind::kPosition, BlockKey::kNoSensor,
      -scale * (Skew(v_n) * NedTurn(context.state.p_e)).row(2), &out->H);
  context.layout.AddColumns(BlockKind::kScale, context.sensor_index,
                            Eigen::Matrix<double, 1, 1>(climb), &out->H);
}

const GenericModel& ClimbModel() {
  static const GenericModel kModel = {[](const GenericReading&) { return 1; },
                                      EvaluateClimb};
  return kModel;
}

constexpr const char* kAdvice = "climbs and descents between position fixes";

SensorBlock ClimbScale() {
  SensorBlock scale = ScaleBlock();
  scale.advice = kAdvice;
  return scale;
}

/// Sensor::own[0] is its sigma [m/s].
SensorBlock Drift() {
  return {
      .kind = BlockKind::kOffset,
      .name = "drift",
      .unit = "m/s",
      .sigma = [](const Sensor& sensor,
                  const MeasurementModel*) -> std::optional<Eigen::Vector3d> {
        if (sensor.own[0] <= 0.0) return std::nullopt;
        return OnAllAxes(sensor.own[0]);
      },
      .evolution =
          [](const Sensor& sensor) {
            return Evolution::GaussMarkov(sensor.own[0], 20.0);
          }};
}

const SensorKind& Variometer() {
  static const SensorKind kKind = {
      .name = "variometer",
      .help = "velocity upwards, made up for a test",
      .residual_unit = "m/s",
      .columns = {{"climb", Quantity::kSpeed}, {"quality", Quantity::kRatio}},
      .measured =
          [](const SensorSettings&) {
            return MeasuredColumns{0, 1, 0};
          },
      .keys = {NeededSigmaKey(Quantity::kSpeed, "of the velocity upwards"),
               ScaleKey(),
               LeverArmKey(),
               LeverArmSigmaKey(),
               ScaleSigmaKey(),
               {.name = "estimate.drift",
                .quantity = Quantity::kSpeed,
                .value = SensorKey::Number{[](SensorSettings& s) {
                                             return &s.sensor.own[0];
                                           },
                                           SensorKey::Range::kPositive},
                .help = "stationary sigma of the drift"}},
      .blocks = {ClimbScale(), LeverArmBlock(), TimeOffsetBlock(), Drift()},
      .prepare =
          [](SensorSettings* s) {
            GenericReading z;
            z.model = &ClimbModel();
            s->pattern = z;
          },
      .complete = [](SensorSettings* s) -> std::optional<KeyObjection> {
        PatternOf<GenericReading>(*s).sigma(0) = s->sigma->x();
        return std::nullopt;
      },
      .uncomplete =
          [](SensorSettings* s) {
            s->sigma.emplace().setConstant(
                PatternOf<GenericReading>(*s).sigma(0));
          },
      .read = [](const MeasuredRow& row, const SensorSettings& settings)
          -> std::optional<MeasurementModel> {
        GenericReading z = PatternOf<GenericReading>(settings);
        z.value(0) = row.Value(0);
        return z;
      },
      .written =
          [](const MeasurementModel&, const Sensor&) {
            return std::vector<WrittenColumn>{{"climb", "m/s"}};
          },
      .write =
          [](const MeasurementModel& z, const Sensor&) {
            return std::vector<double>{std::get<GenericReading>(z).value(0)};
          },
      .perfect = [](const SensorSettings& settings,
                    const Motion& motion) -> std::optional<MeasurementModel> {
        GenericReading z = PatternOf<GenericReading>(settings);
        const Eigen::Vector3d v_e =
            motion.v_e +
            motion.q_eb * motion.w_eb_b.cross(settings.sensor.lever_arm_b);
        z.value(0) = -(NedAxes(motion.p_e).transpose() * v_e).z();
        return z;
      },
      .disturb =
          [](const SensorSettings& settings, Random* random,
             std::vector<Measurement>* measurements) {
            for (Measurement& z : *measurements) {
              auto& reading = std::get<GenericReading>(z.model);
              reading.value(0) =
                  (1.0 + settings.truth.scale) * reading.value(0) +
                  reading.sigma(0) * random->Normal();
            }
          },
  };
  return kKind;
}

/// A hilly drive with positions that leave the height to the variometer.
class MadeUpSensor : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (FindSensorKind("variometer") == nullptr) AddSensorKind(Variometer());
  }

  std::string WriteRecording(const std::string& sensor_keys) const {
    folder_.Write(
        "scenario.yaml",
        "start: {position: [48 deg, 11 deg, 500 m], speed: 10 m/s}\n"
        "segments:\n"
        "  - {type: straight, duration: 10 s}\n"
        "  - {type: pitch, angle: 10 deg, rate: 5 deg/s}\n"
        "  - {type: turn, angle: 90 deg, rate: 10 deg/s}\n"
        "  - {type: pitch, angle: -20 deg, rate: 5 deg/s}\n"
        "  - {type: turn, angle: -90 deg, rate: 10 deg/s}\n"
        "  - {type: pitch, angle: 10 deg, rate: 5 deg/s}\n"
        "  - {type: straight, duration: 20 s}\n"
        "imu: {rate: 50 Hz, noise: {gyro: 0.1 deg/sqrt(h), accel: "
        "100 ug/sqrt(Hz)}}\n"
        "start_errors: {position: 0.5 m, velocity: 0.1 m/s, "
        "attitude: 0.5 deg}\n"
        "aiding:\n"
        "  gnss: {type: position, sigma: [0.5, 0.5, 5 m]}\n"
        "  climb:\n    {type: variometer, rate: 10 Hz, sigma: 2 cm/s, "
        "lever_arm: [1, 0.5, -1 m]" +
            sensor_keys + "}\n");
    const Dataset dataset =
        Simulate(LoadScenario(folder_.Path("scenario.yaml")), 7);
    WriteDataset(dataset, folder_.Path("drive"));
    return folder_.Path("drive/config.yaml");
  }

  TemporaryFolder folder_;
};

TEST_F(MadeUpSensor, IsSimulatedWrittenAndReadTheSame) {
  const std::string config = WriteRecording("");
  const Dataset simulated =
      Simulate(LoadScenario(folder_.Path("scenario.yaml")), 7);
  const Dataset read = LoadDataset(config);
  ASSERT_EQ(read.streams.size(), 2U);
  const AidingStream& climb = read.streams[1];
  EXPECT_EQ(climb.sensor.kind, &Variometer());
  EXPECT_EQ(climb.sensor.lever_arm_b, simulated.streams[1].sensor.lever_arm_b);
  ASSERT_EQ(climb.measurements.size(),
            simulated.streams[1].measurements.size());
  const Measurement a = climb.measurements[100];
  const Measurement b = simulated.streams[1].measurements[100];
  EXPECT_EQ(a.t, b.t);
  EXPECT_EQ(std::get<GenericReading>(a.model).value,
            std::get<GenericReading>(b.model).value);
  EXPECT_EQ(std::get<GenericReading>(a.model).sigma(0), 0.02);
}

TEST_F(MadeUpSensor, ServesEveryMethodThatTakesPositions) {
  const Dataset dataset =
      LoadDataset(WriteRecording(", estimate: {scale: 2 %}"));
  for (const Method* method : Methods()) {
    if (method->attitude_alone()) continue;
    const Solution solution = Reconstruction(dataset, {}).Run(method->name);
    long used = 0;
    double sum = 0.0;
    for (const ResidualRecord& record : solution.residuals) {
      if (record.sensor != 1 || !record.accepted) continue;
      ++used;
      sum += record.nis;
    }
    EXPECT_GT(used, 500) << method->name;
    EXPECT_LT(sum / static_cast<double>(used), 1.5) << method->name;
    EXPECT_NE(solution.layout.Find(BlockKind::kScale, 1), nullptr);
  }
}

TEST_F(MadeUpSensor, BringsItsOwnBlocksWithTheirEvolutionAndAdvice) {
  const Dataset dataset =
      LoadDataset(WriteRecording(", estimate: {scale: 0.1 %, drift: 1 cm/s}"));
  const Solution solution = Reconstruction(dataset, {}).Run("batch");
  const Block* scale = solution.layout.Find(BlockKind::kScale, 1);
  ASSERT_NE(scale, nullptr);
  EXPECT_EQ(scale->name, "climb_scale");
  EXPECT_EQ(scale->sigma0.x(), 0.001);
  const Block* drift = solution.layout.Find(BlockKind::kOffset, 1);
  ASSERT_NE(drift, nullptr);
  EXPECT_EQ(drift->name, "climb_drift");
  EXPECT_EQ(drift->unit, "m/s");
  EXPECT_NEAR(drift->evolution.StationaryVariance(), 1e-4, 1e-16);
  EXPECT_EQ(drift->evolution.tau, 20.0);
  // Only constants are reported, and this one is known as well beforehand.
  const auto constant = std::find_if(
      solution.constants.begin(), solution.constants.end(),
      [](const ConstantEstimate& c) { return c.name == "climb_scale"; });
  ASSERT_NE(constant, solution.constants.end());
  EXPECT_EQ(constant->advice, kAdvice);
}

TEST_F(MadeUpSensor, IsInTheHelpThePageAndTheSchema) {
  const std::string help = ConfigHelp("aiding: variometer");
  EXPECT_NE(help.find("Velocity upwards, made up for a test"),
            std::string::npos)
      << help;
  EXPECT_NE(help.find("estimate.drift"), std::string::npos) << help;
  EXPECT_NE(ConfigMarkdown().find("stationary sigma of the drift"),
            std::string::npos);
  const std::string schema = ConfigSchema();
  EXPECT_NE(schema.find("\"variometer\""), std::string::npos);
  EXPECT_NE(schema.find("\"drift\""), std::string::npos);
}

TEST_F(MadeUpSensor, IsCheckedWithheldAndRefused) {
  const std::string config = WriteRecording("");
  Dataset dataset = LoadDataset(config);
  dataset.withholdings = {{"variometer", 20.0, 5.0, std::nullopt}};
  ApplyWithholding(&dataset);
  EXPECT_EQ(dataset.outages.front().sensor, 1);
  const CheckReport report = CheckDataset(dataset);
  ASSERT_EQ(report.streams.size(), 4U);
  EXPECT_EQ(report.streams[2].name, "climb");
  EXPECT_NEAR(report.streams[2].rate, 10.0, 1e-6);
  folder_.Write("drive/bad.yaml",
                "imu: {file: imu.csv, noise: {gyro: 1 deg/sqrt(h), accel: 1 "
                "mg/sqrt(Hz)}}\naiding:\n  climb: {type: variometer, file: "
                "climb.csv, sigma: 2 m}\n");
  try {
    LoadDataset(folder_.Path("drive/bad.yaml"));
    FAIL() << "a length as the sigma of a speed";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("sigma"), std::string::npos);
  }
}

}  // namespace
}  // namespace hindsight
