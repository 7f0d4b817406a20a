#include "measurements/heading.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "measurements/point_motion.h"
#include "measurements/sensor_kind.h"

namespace hindsight {

Eigen::Vector2d DirectionOf(const Eigen::Vector3d& u_n) {
  return {std::atan2(u_n.y(), u_n.x()),
          std::atan2(-u_n.z(), std::hypot(u_n.x(), u_n.y()))};
}

namespace {

int RowsOf(const GenericReading& z) { return z.sigma(1) > 0.0 ? 2 : 1; }

void EvaluateDirection(const GenericReading& z, const ModelContext& context,
                       LinearizedMeasurement* out) {
  constexpr double kLeast = 1e-4;  // of the horizontal part, of a vertical b
  const PointMotion motion = MotionOfSensor(context);
  const ErrorLayout& layout = context.layout;
  const int rows = RowsOf(z);
  const Eigen::Vector3d b = context.sensor.own_vector.normalized();
  const Eigen::Matrix3d C_nb = motion.C_en.transpose() * motion.C_eb;
  const Eigen::Vector3d u = C_nb * b;
  const double h = std::max(u.head<2>().norm(), kLeast);
  RowTimes3 by_u = RowTimes3::Zero(rows, 3);
  by_u.row(0) << -u.y() / (h * h), u.x() / (h * h), 0.0;
  const Eigen::Vector2d predicted = DirectionOf(u);
  out->Resize(rows, layout.dim());
  out->residual(0) = std::remainder(z.value(0) - predicted(0), 2.0 * kPi);
  out->R(0, 0) = z.sigma(0) * z.sigma(0);
  if (rows == 2) {
    by_u.row(1) << u.x() * u.z() / h, u.y() * u.z() / h, -h;
    out->residual(1) = z.value(1) - predicted(1);
    out->R(1, 1) = z.sigma(1) * z.sigma(1);
  }
  const RowTimes3 by_psi = -by_u * Skew(u);
  layout.AddColumns(BlockKind::kAttitude, BlockKey::kNoSensor, by_psi, &out->H);
  layout.AddColumns(BlockKind::kPosition, BlockKey::kNoSensor,
                    -by_psi * NedTurn(context.state.p_e), &out->H);
  layout.AddColumns(BlockKind::kTimeOffset, context.sensor_index,
                    by_u * C_nb * motion.w_eb_b.cross(b), &out->H);
}

bool HasPitch(const SensorSettings& settings) {
  return settings.sensor.own[0] > 0.0;
}

std::optional<KeyObjection> CompleteHeading(SensorSettings* settings) {
  PatternOf<GenericReading>(*settings).sigma.head<2>() << settings->sigma->x(),
      settings->sensor.own[0];
  if (settings->sensor.own_vector.norm() > 0.0) return std::nullopt;
  return KeyObjection{"baseline", "expected a vector other than zero"};
}

std::optional<MeasurementModel> ReadHeading(const MeasuredRow& row,
                                            const SensorSettings& settings) {
  GenericReading z = PatternOf<GenericReading>(settings);
  z.value(0) = row.Value(0);
  if (HasPitch(settings)) z.value(1) = row.Value(1);
  return z;
}

std::optional<MeasurementModel> PerfectHeading(const SensorSettings& settings,
                                               const Motion& motion) {
  const Eigen::Vector3d u_e = motion.q_eb * settings.sensor.own_vector;
  const Eigen::Vector3d u_n = NedAxes(motion.p_e).transpose() * u_e;
  GenericReading z = PatternOf<GenericReading>(settings);
  z.value(0) = std::atan2(u_n.y(), u_n.x());
  z.value(1) = -std::asin(std::clamp(u_n.z() / u_n.norm(), -1.0, 1.0));
  return z;
}

void DisturbHeadings(const SensorSettings&, Random* random,
                     std::vector<Measurement>* measurements) {
  for (Measurement& z : *measurements) {
    auto& reading = std::get<GenericReading>(z.model);
    for (int i = 0; i < 2; ++i) {
      reading.value(i) += reading.sigma(i) * random->Normal();
    }
  }
}

SensorKeys HeadingKeys() {
  using Range = SensorKey::Range;
  return {
      {.name = "baseline",
       .quantity = Quantity::kLength,
       .value = SensorKey::Vector{[](SensorSettings& s) {
         return &s.sensor.own_vector;
       }},
       .help =
           "from the antenna that the direction is measured at to the other, "
           "body axes; its length does not count"},
      NeededSigmaKey(Quantity::kAngle, "of the heading"),
      {.name = "pitch_sigma",
       .quantity = Quantity::kAngle,
       .value =
           SensorKey::Number{[](SensorSettings& s) { return &s.sensor.own[0]; },
                             Range::kPositive},
       .help = "of the pitch, if it is used"}};
}

}  // namespace

const GenericModel& BaselineDirection() {
  static const GenericModel kModel = {RowsOf, EvaluateDirection};
  return kModel;
}

const SensorKind& HeadingKind() {
  static const SensorKind kKind = {
      .name = "heading",
      .help = "heading and pitch of a baseline: two antennas, a gyrocompass",
      .residual_unit = "rad",
      .is_heading = true,
      .columns = {{"heading", Quantity::kAngle},
                  {"pitch", Quantity::kAngle},
                  {"quality", Quantity::kRatio}},
      .measured =
          [](const SensorSettings& settings) {
            return MeasuredColumns{0, HasPitch(settings) ? 2U : 1U, 0};
          },
      .keys = HeadingKeys(),
      .blocks = {TimeOffsetBlock()},
      .prepare =
          [](SensorSettings* s) {
            GenericReading z;
            z.model = &BaselineDirection();
            s->pattern = z;
            s->sensor.own_vector = Eigen::Vector3d::UnitX();
          },
      .complete = CompleteHeading,
      .uncomplete =
          [](SensorSettings* s) {
            s->sigma.emplace().setConstant(
                PatternOf<GenericReading>(*s).sigma(0));
          },
      .read = ReadHeading,
      .written =
          [](const MeasurementModel& z, const Sensor&) {
            std::vector<WrittenColumn> columns = {{"heading", "rad"}};
            if (std::get<GenericReading>(z).sigma(1) > 0.0) {
              columns.push_back({"pitch", "rad"});
            }
            return columns;
          },
      .write =
          [](const MeasurementModel& z, const Sensor&) {
            const auto& reading = std::get<GenericReading>(z);
            std::vector<double> values = {reading.value(0)};
            if (reading.sigma(1) > 0.0) values.push_back(reading.value(1));
            return values;
          },
      .perfect = PerfectHeading,
      .disturb = DisturbHeadings,
  };
  return kKind;
}

}  // namespace hindsight
