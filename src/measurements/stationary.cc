#include "measurements/stationary.h"

#include "geometry/so3.h"
#include "imu/imu_link.h"
#include "measurements/point_motion.h"
#include "measurements/sensor_kind.h"
#include "measurements/standing_flags.h"

namespace hindsight {

void ZeroVelocity::Evaluate(const ModelContext& context,
                            LinearizedMeasurement* out) const {
  const State& x = context.state;
  const Eigen::Vector3d v_n = x.v_n();
  out->Resize(rows(), context.layout.dim());
  out->residual = -v_n;
  context.layout.AddColumns(BlockKind::kVelocity, BlockKey::kNoSensor,
                            Eigen::Matrix3d::Identity(), &out->H);
  context.layout.AddColumns(BlockKind::kPosition, BlockKey::kNoSensor,
                            Skew(v_n) * NedTurn(x.p_e), &out->H);
  out->R.diagonal().setConstant(sigma * sigma);
}

void ZeroAngularRate::Evaluate(const ModelContext& context,
                               LinearizedMeasurement* out) const {
  const State& x = context.state;
  const ErrorLayout& layout = context.layout;
  const ImuCalibration calibration = CalibrationOf(layout, x);
  const Eigen::Matrix3d C_be = x.q_eb.conjugate().toRotationMatrix();
  const Eigen::Vector3d earth_b = C_be * EarthRate_e();
  const Eigen::Vector3d factor = 1.0 + calibration.s_g.array();
  out->Resize(rows(), layout.dim());
  out->residual = w_ib_b - factor.cwiseProduct(earth_b) - x.b_g;
  layout.AddColumns(BlockKind::kAttitude, BlockKey::kNoSensor,
                    factor.asDiagonal() * C_be * Skew(EarthRate_e()) * x.C_en(),
                    &out->H);
  layout.AddColumns(BlockKind::kGyroBias, BlockKey::kNoSensor,
                    Eigen::Matrix3d::Identity(), &out->H);
  layout.AddColumns(BlockKind::kGyroScale, BlockKey::kNoSensor,
                    Eigen::Matrix3d(earth_b.asDiagonal()), &out->H);
  out->R.diagonal().setConstant(sigma * sigma);
}

const SensorKind& ZeroVelocityKind() {
  static const SensorKind kKind = {
      .name = "zero_velocity",
      .help = "times at which the IMU stands",
      .residual_unit = "m/s",
      .standing = true,
      .has_clock = false,
      .columns = {{"zero_velocity", Quantity::kRatio},
                  {"quality", Quantity::kRatio}},
      .measured =
          [](const SensorSettings&) {
            return MeasuredColumns{0, 1, 0};
          },
      .keys = {NeededSigmaKey(
          Quantity::kSpeed,
          "of each axis: how fast it may still move in a stance")},
      .prepare = [](SensorSettings* s) { s->pattern = ZeroVelocity(); },
      .complete = [](SensorSettings* s) -> std::optional<KeyObjection> {
        PatternOf<ZeroVelocity>(*s).sigma = s->sigma->x();
        return std::nullopt;
      },
      .uncomplete =
          [](SensorSettings* s) {
            s->sigma.emplace().setConstant(PatternOf<ZeroVelocity>(*s).sigma);
          },
      .read = [](const MeasuredRow& row, const SensorSettings& settings)
          -> std::optional<MeasurementModel> {
        if (!row.Flag(0)) return std::nullopt;
        return settings.pattern;
      },
      .unread = "row without the flag",
      .join = [](const SensorSettings&,
                 MeasurementSeries* all) { ShareErrorsOfStances(all); },
      .written =
          [](const MeasurementModel&, const Sensor&) {
            return std::vector<WrittenColumn>{{"zero_velocity", "1", 1.0, -1}};
          },
      .write = [](const MeasurementModel&,
                  const Sensor&) { return std::vector<double>{1.0}; },
      .perfect = [](const SensorSettings& settings,
                    const Motion& motion) -> std::optional<MeasurementModel> {
        constexpr double kStands = 1e-6;
        if (motion.v_e.norm() > kStands) return std::nullopt;
        return settings.pattern;
      },
      .disturb = [](const SensorSettings&, Random*,
                    std::vector<Measurement>*) {},
  };
  return kKind;
}

const SensorKind& ZeroAngularRateKind() {
  static const SensorKind kKind = {
      .name = "zero_angular_rate",
      .help = "times at which the IMU does not turn",
      .configured = false,
      .residual_unit = "rad/s",
      .standing = true,
      .has_clock = false,
      .prepare = [](SensorSettings* s) { s->pattern = ZeroAngularRate(); },
  };
  return kKind;
}

}  // namespace hindsight
