#include "measurements/acoustic_fix.h"

#include <cmath>

#include "measurements/sensor_axes.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

/// e_1 and e_2 as rows.
Eigen::Matrix<double, 2, 3> Across(double azimuth, double depression) {
  const double sa = std::sin(azimuth);
  const double ca = std::cos(azimuth);
  const double sd = std::sin(depression);
  const double cd = std::cos(depression);
  Eigen::Matrix<double, 2, 3> across;
  across << -sa, ca, 0.0, -sd * ca, -sd * sa, cd;
  return across;
}

}  // namespace

void AcousticFix::Evaluate(const ModelContext& context,
                           LinearizedMeasurement* out) const {
  const ErrorLayout& layout = context.layout;
  const int sensor = context.sensor_index;
  const PointMotion motion = MotionOfSensor(context);
  const Eigen::Vector3d d_e = p_t_e - motion.p_e;
  const double r = d_e.norm();
  const Eigen::Vector3d u_e = d_e / r;
  out->Resize(rows(), layout.dim());
  int row = 0;
  if (has_range) {
    const double k = Parameter1(layout, context.state, BlockKind::kScale,
                                sensor, context.sensor.scale);
    out->residual(0) = range - (1.0 + k) * r;
    out->R(0, 0) = sigma_range * sigma_range;
    RowJacobian H = RowJacobian::Zero(1, layout.dim());
    AddPositionColumns(context, motion, -(1.0 + k) * u_e.transpose(), &H);
    layout.AddColumns(BlockKind::kScale, sensor,
                      Eigen::Matrix<double, 1, 1>::Constant(r), &H);
    out->H.topRows(1) = H;
    row = 1;
  }
  if (!has_bearing) return;
  const SensorAxes axes = AxesOfSensor(context, motion);
  const RowTimes3 A = Across(azimuth, depression);
  out->residual.segment<2>(row) = -(A * (axes.C_se * u_e));
  out->R.diagonal().segment<2>(row).setConstant(sigma_bearing * sigma_bearing);
  RowJacobian H = RowJacobian::Zero(2, layout.dim());
  // d u = -(I - u u') dp / r
  const Eigen::Matrix3d turn =
      -(Eigen::Matrix3d::Identity() - u_e * u_e.transpose()) / r;
  AddPositionColumns(context, motion, A * axes.C_se * turn, &H);
  AddAxesColumns(context, motion, axes, u_e, A, &H);
  out->H.middleRows(row, 2) = H;
}

namespace {

std::optional<KeyObjection> CompleteAcoustic(SensorSettings* settings) {
  auto& fix = PatternOf<AcousticFix>(*settings);
  fix.has_range = settings->sigma.has_value();
  if (fix.has_range) fix.sigma_range = settings->sigma->x();
  fix.has_bearing = settings->sensor.own[0] > 0.0;
  if (fix.has_bearing) fix.sigma_bearing = settings->sensor.own[0];
  if (fix.rows() == 0) {
    return KeyObjection{
        "sigma",
        "is missing; expected sigma of a range, bearing_sigma, or both"};
  }
  return std::nullopt;
}

MeasuredColumns AcousticColumns(const SensorSettings& settings) {
  const auto& fix = PatternOf<AcousticFix>(settings);
  const std::size_t first = fix.has_range ? 0 : 1;
  const std::size_t end = fix.has_bearing ? 3 : 1;
  return {first, end - first, 0};
}

std::optional<MeasurementModel> ReadAcoustic(const MeasuredRow& row,
                                             const SensorSettings& settings) {
  AcousticFix fix = PatternOf<AcousticFix>(settings);
  if (fix.has_range) fix.range = row.Value(0);
  if (fix.has_bearing) {
    fix.azimuth = row.Value(1);
    fix.depression = row.Value(2);
  }
  return fix;
}

std::optional<MeasurementModel> PerfectAcoustic(const SensorSettings& settings,
                                                const Motion& motion) {
  AcousticFix fix = PatternOf<AcousticFix>(settings);
  const Eigen::Vector3d d_b =
      motion.q_eb.conjugate() * (fix.p_t_e - motion.p_e) -
      settings.sensor.lever_arm_b;
  const Eigen::Vector3d d_s = settings.sensor.q_sb * d_b;
  fix.range = d_s.norm();
  fix.azimuth = std::atan2(d_s.y(), d_s.x());
  fix.depression = std::atan2(d_s.z(), d_s.head<2>().norm());
  return fix;
}

void DisturbAcoustics(const SensorSettings& settings, Random* random,
                      std::vector<Measurement>* measurements) {
  for (Measurement& z : *measurements) {
    auto& fix = std::get<AcousticFix>(z.model);
    fix.range = (1.0 + settings.truth.scale) * fix.range +
                fix.sigma_range * random->Normal();
    // Across the line of sight, so that azimuths scatter more near the
    // vertical.
    fix.azimuth +=
        fix.sigma_bearing * random->Normal() / std::cos(fix.depression);
    fix.depression += fix.sigma_bearing * random->Normal();
  }
}

}  // namespace

const SensorKind& AcousticKind() {
  static const SensorKind kKind = {
      .name = "acoustic",
      .help = "range and bearing to a transponder",
      .places = true,
      .columns = {{"range", Quantity::kLength},
                  {"azimuth", Quantity::kAngle},
                  {"depression", Quantity::kAngle},
                  {"quality", Quantity::kRatio}},
      .measured = AcousticColumns,
      .keys = {{.name = "transponder",
                .value = SensorKey::Place{[](SensorSettings& s) {
                  return &PatternOf<AcousticFix>(s).p_t_e;
                }},
                .help = "[latitude, longitude, height]",
                .needed = Always,
                .missing =
                    "is missing; expected [latitude, longitude, height]"},
               SigmaKey(Quantity::kLength, true, "of the range, if it is used"),
               {.name = "bearing_sigma",
                .quantity = Quantity::kAngle,
                .value = SensorKey::Number{[](SensorSettings& s) {
                                             return &s.sensor.own[0];
                                           },
                                           SensorKey::Range::kPositive},
                .help = "of the bearing (azimuth, depression), if it is used"},
               MountingKey(),
               ScaleKey(),
               LeverArmKey(),
               LeverArmSigmaKey(),
               MountingSigmaKey(),
               ScaleSigmaKey()},
      .blocks = {ScaleBlock(), MountingBlock(), LeverArmBlock(),
                 TimeOffsetBlock()},
      .prepare = [](SensorSettings* s) { s->pattern = AcousticFix(); },
      .complete = CompleteAcoustic,
      .uncomplete =
          [](SensorSettings* s) {
            const auto& fix = PatternOf<AcousticFix>(*s);
            if (fix.has_range) s->sigma.emplace().setConstant(fix.sigma_range);
            s->sensor.own[0] = fix.has_bearing ? fix.sigma_bearing : 0.0;
          },
      .read = ReadAcoustic,
      .written =
          [](const MeasurementModel&, const Sensor&) {
            return std::vector<WrittenColumn>{
                {"range", "m"}, {"azimuth", "rad"}, {"depression", "rad"}};
          },
      .write =
          [](const MeasurementModel& z, const Sensor&) {
            const auto& fix = std::get<AcousticFix>(z);
            return std::vector<double>{fix.range, fix.azimuth, fix.depression};
          },
      .perfect = PerfectAcoustic,
      .disturb = DisturbAcoustics,
  };
  return kKind;
}

}  // namespace hindsight
