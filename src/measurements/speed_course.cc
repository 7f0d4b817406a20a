#include "measurements/speed_course.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "measurements/point_motion.h"
#include "measurements/sensor_kind.h"

namespace hindsight {

void SpeedCourse::Evaluate(const ModelContext& context,
                           LinearizedMeasurement* out) const {
  const PointMotion motion = MotionOfSensor(context);
  const Eigen::Matrix3d C_ne = motion.C_en.transpose();
  const Eigen::Vector3d v_n = C_ne * motion.v_e;
  Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kMaxRows, 3> axes(rows(), 3);
  out->Resize(rows(), context.layout.dim());
  if (has_course) {
    constexpr double kSlow = 1.0;
    const double s = std::sin(course);
    const double c = std::cos(course);
    axes << c, s, 0.0, -s, c, 0.0;
    out->residual = -axes * v_n;
    out->residual(0) += speed;
    const double sigma_across = std::max(std::abs(speed), kSlow) * sigma_course;
    out->R(1, 1) = sigma_across * sigma_across;
    out->R(0, 0) = sigma_speed * sigma_speed;
  } else if (is_slow()) {
    axes << 1.0, 0.0, 0.0, 0.0, 1.0, 0.0;
    out->residual = -axes * v_n;
    out->R.diagonal().setConstant(speed * speed + sigma_speed * sigma_speed);
  } else {
    // Near zero a parabola with the same slope there.
    const double v = v_n.head<2>().norm();
    const double at_least = std::max(v, sigma_speed);
    axes << v_n.x() / at_least, v_n.y() / at_least, 0.0;
    out->residual(0) = speed - 0.5 * (at_least + v * v / at_least);
    out->R(0, 0) = sigma_speed * sigma_speed;
  }
  AddVelocityColumns(context, motion, axes * C_ne, &out->H);
  context.layout.AddColumns(BlockKind::kPosition, BlockKey::kNoSensor,
                            axes * Skew(v_n) * NedTurn(context.state.p_e),
                            &out->H);
}

namespace {

/// Speed below which a course means nothing [m/s].
double CourseAbove(const SensorSettings& settings) {
  return settings.sensor.own[0];
}

std::optional<MeasurementModel> ReadSpeedCourse(
    const MeasuredRow& row, const SensorSettings& settings) {
  SpeedCourse measured = PatternOf<SpeedCourse>(settings);
  measured.speed = row.Value(0);
  if (measured.speed < -CourseAbove(settings)) {
    row.Fail(settings.sensor.name + ": the speed is " +
             FormatNumber(measured.speed) +
             " m/s; a speed over the ground is not negative: a leading \"-\" "
             "before its column under `columns` turns the sign");
  }
  measured.has_course = row.Has(1) && std::isfinite(row.Value(1)) &&
                        measured.speed >= CourseAbove(settings);
  if (measured.has_course) measured.course = row.Value(1);
  return measured;
}

/// Of the horizontal velocity of the sensor's point.
std::optional<MeasurementModel> PerfectSpeedCourse(
    const SensorSettings& settings, const Motion& motion) {
  SpeedCourse measured = PatternOf<SpeedCourse>(settings);
  const Eigen::Vector3d v_e =
      motion.v_e +
      motion.q_eb * motion.w_eb_b.cross(settings.sensor.lever_arm_b);
  const Eigen::Vector3d v_n = NedAxes(motion.p_e).transpose() * v_e;
  measured.speed = std::hypot(v_n.x(), v_n.y());
  measured.course = std::atan2(v_n.y(), v_n.x());
  measured.has_course = measured.speed >= CourseAbove(settings);
  return measured;
}

void DisturbSpeedCourses(const SensorSettings&, Random* random,
                         std::vector<Measurement>* measurements) {
  for (Measurement& z : *measurements) {
    auto& measured = std::get<SpeedCourse>(z.model);
    measured.speed =
        std::abs(measured.speed + measured.sigma_speed * random->Normal());
    measured.course += measured.sigma_course * random->Normal();
  }
}

}  // namespace

const SensorKind& SpeedCourseKind() {
  static const SensorKind kKind = {
      .name = "speed_course",
      .help = "speed and course over the ground, as NMEA RMC has them",
      .moves = true,
      .columns = {{"speed", Quantity::kSpeed},
                  {"course", Quantity::kAngle},
                  {"quality", Quantity::kRatio}},
      .measured =
          [](const SensorSettings&) {
            return MeasuredColumns{0, 1, 0};
          },
      .has_optional_columns = true,
      .keys = {NeededSigmaKey(Quantity::kSpeed, "of the speed"),
               {.name = "course_sigma",
                .quantity = Quantity::kAngle,
                .value = SensorKey::Number{[](SensorSettings& s) {
                                             return &PatternOf<SpeedCourse>(s)
                                                         .sigma_course;
                                           },
                                           SensorKey::Range::kPositive},
                .help = "of the course",
                .needed = Always},
               {.name = "course_above",
                .quantity = Quantity::kSpeed,
                .value = SensorKey::Number{[](SensorSettings& s) {
                  return &s.sensor.own[0];
                }},
                .help = "speed below which the course is not used"},
               LeverArmKey(),
               LeverArmSigmaKey()},
      .blocks = {LeverArmBlock(), TimeOffsetBlock()},
      .prepare =
          [](SensorSettings* s) {
            s->pattern = SpeedCourse();
            s->sensor.own[0] = 1.0;
          },
      .complete = [](SensorSettings* s) -> std::optional<KeyObjection> {
        PatternOf<SpeedCourse>(*s).sigma_speed = s->sigma->x();
        return std::nullopt;
      },
      .uncomplete =
          [](SensorSettings* s) {
            s->sigma.emplace().setConstant(
                PatternOf<SpeedCourse>(*s).sigma_speed);
          },
      .read = ReadSpeedCourse,
      .written =
          [](const MeasurementModel&, const Sensor&) {
            return std::vector<WrittenColumn>{{"speed", "m/s"},
                                              {"course", "rad"}};
          },
      .write =
          [](const MeasurementModel& z, const Sensor&) {
            const auto& measured = std::get<SpeedCourse>(z);
            return std::vector<double>{measured.speed, measured.course};
          },
      .perfect = PerfectSpeedCourse,
      .disturb = DisturbSpeedCourses,
  };
  return kKind;
}

}  // namespace hindsight
