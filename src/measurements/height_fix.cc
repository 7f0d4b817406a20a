#include "measurements/height_fix.h"

#include "earth/wgs84.h"
#include "measurements/point_motion.h"
#include "measurements/sensor_kind.h"

namespace hindsight {

void HeightFix::Evaluate(const ModelContext& context,
                         LinearizedMeasurement* out) const {
  const PointMotion motion = MotionOfSensor(context);
  const Geodetic g = GeodeticFromEcef(motion.p_e);
  const Eigen::RowVector3d up_e =
      -NedAxes(g.latitude, g.longitude).col(2).transpose();
  out->Resize(rows(), context.layout.dim());
  out->residual(0) = height - g.height -
                     Parameter1(context.layout, context.state,
                                BlockKind::kOffset, context.sensor_index, 0.0);
  AddPositionColumns(context, motion, up_e, &out->H);
  context.layout.AddColumns(BlockKind::kOffset, context.sensor_index,
                            Eigen::Matrix<double, 1, 1>::Identity(), &out->H);
  const NoiseModel& noise = context.sensor.noise;
  const bool coloured =
      noise.correlated() &&
      context.layout.Has(BlockKind::kOffset, context.sensor_index);
  const double white = coloured ? noise.white_sigma : sigma;
  out->R(0, 0) = white * white;
}

namespace {

/// Height of the water's surface above the ellipsoid, of a depth [m].
double& Surface(SensorSettings& settings) { return settings.sensor.own[0]; }

SensorKey OffsetSigmaKey() {
  return {.name = "estimate.offset",
          .quantity = Quantity::kLength,
          .value = SensorKey::OptionalNumber{[](SensorSettings& s) {
            return &s.sensor.offset_sigma;
          }},
          .help = "a priori sigma of an additive constant"};
}

std::optional<KeyObjection> RefuseTwoOffsets(SensorSettings* settings) {
  const Sensor& sensor = settings->sensor;
  if (sensor.offset_sigma && sensor.noise.correlated()) {
    return KeyObjection{"estimate", "offset does not go with correlated noise"};
  }
  return std::nullopt;
}

std::optional<MeasurementModel> PerfectHeight(const SensorSettings& settings,
                                              const Motion& motion) {
  const Eigen::Vector3d p_e =
      motion.p_e + motion.q_eb * settings.sensor.lever_arm_b;
  return HeightFix{GeodeticFromEcef(p_e).height, settings.sigma->z()};
}

void DisturbHeights(const SensorSettings& settings, Random* random,
                    std::vector<Measurement>* measurements) {
  for (Measurement& z : *measurements) {
    std::get<HeightFix>(z.model).height +=
        settings.truth.offset + settings.sigma->z() * random->Normal();
  }
}

SensorBlock OffsetBlock() {
  return {
      .kind = BlockKind::kOffset,
      .name = "offset",
      .unit = "m",
      .sigma =
          [](const Sensor& sensor, const MeasurementModel*) {
            return OnAllAxes(sensor.offset_sigma);
          },
      .value =
          [](const Sensor& sensor) {
            return Eigen::Vector3d(Eigen::Vector3d::Constant(sensor.offset));
          },
      .advice = "position fixes with height",
      .know =
          [](const Eigen::Vector3d& value, const Eigen::Vector3d& sigma,
             Sensor* sensor) {
            sensor->offset = value.x();
            sensor->offset_sigma = sigma.x();
          }};
}

SensorKind Vertical(std::string_view name, std::string_view help) {
  return {
      .name = name,
      .help = help,
      .family = "height",
      .residual_unit = "m",
      .is_height = true,
      .coloured = Quantity::kLength,
      .states_sigma = true,
      .measured =
          [](const SensorSettings&) {
            return MeasuredColumns{0, 1, 1};
          },
      .keys = {SigmaKey(Quantity::kLength, true, "replaces the file's"),
               LeverArmKey(), LeverArmSigmaKey(), OffsetSigmaKey()},
      .blocks = {LeverArmBlock(), TimeOffsetBlock(),
                 NoiseBlock(BlockKind::kOffset, "m"), OffsetBlock()},
      .prepare = [](SensorSettings* s) { s->pattern = HeightFix(); },
      .complete = RefuseTwoOffsets,
  };
}

SensorKind MakeHeight() {
  SensorKind kind =
      Vertical("height", "heights above the ellipsoid: barometer, map");
  kind.columns = {{"h", Quantity::kLength},
                  {"sigma_h", Quantity::kLength},
                  {"quality", Quantity::kRatio}};
  kind.read = [](const MeasuredRow& row,
                 const SensorSettings&) -> std::optional<MeasurementModel> {
    return HeightFix{row.Value(0), row.Sigma(0)};
  };
  kind.written = [](const MeasurementModel&, const Sensor&) {
    return std::vector<WrittenColumn>{{"h", "m", 1.0, 7},
                                      {"sigma_h", "m", 1.0, -12}};
  };
  kind.write = [](const MeasurementModel& z, const Sensor&) {
    const auto& fix = std::get<HeightFix>(z);
    return std::vector<double>{fix.height, fix.sigma};
  };
  kind.perfect = PerfectHeight;
  kind.disturb = DisturbHeights;
  return kind;
}

SensorKind MakeDepth() {
  SensorKind kind = Vertical("depth", "depths below the water's surface");
  kind.columns = {{"depth", Quantity::kLength},
                  {"sigma_depth", Quantity::kLength},
                  {"quality", Quantity::kRatio}};
  kind.keys.push_back(
      {.name = "surface",
       .quantity = Quantity::kLength,
       .value =
           SensorKey::Number{[](SensorSettings& s) { return &Surface(s); }},
       .help = "height of the water's surface above the ellipsoid"});
  kind.read =
      [](const MeasuredRow& row,
         const SensorSettings& settings) -> std::optional<MeasurementModel> {
    return HeightFix{settings.sensor.own[0] - row.Value(0), row.Sigma(0)};
  };
  return kind;
}

}  // namespace

const SensorKind& HeightKind() {
  static const SensorKind kKind = MakeHeight();
  return kKind;
}

const SensorKind& DepthKind() {
  static const SensorKind kKind = MakeDepth();
  return kKind;
}

}  // namespace hindsight
