#include "measurements/velocity_fix.h"

#include "geometry/so3.h"
#include "measurements/point_motion.h"
#include "measurements/sensor_kind.h"

namespace hindsight {

void VelocityFix::Evaluate(const ModelContext& context,
                           LinearizedMeasurement* out) const {
  const PointMotion motion = MotionOfSensor(context);
  const Eigen::Matrix3d C_ne = motion.C_en.transpose();
  const Eigen::Vector3d predicted = C_ne * motion.v_e;
  out->Resize(rows(), context.layout.dim());
  out->residual = v_n - predicted;
  AddVelocityColumns(context, motion, C_ne, &out->H);
  context.layout.AddColumns(BlockKind::kPosition, BlockKey::kNoSensor,
                            Skew(predicted) * NedTurn(context.state.p_e),
                            &out->H);
  out->R = WhiteCovariance(context, R_n);
}

namespace {

std::vector<double> WriteVelocity(const MeasurementModel& z, const Sensor&) {
  const auto& fix = std::get<VelocityFix>(z);
  const Eigen::Vector3d sigma = UncorrelatedSigma(fix.R_n);
  return {fix.v_n.x(), fix.v_n.y(), fix.v_n.z(),
          sigma.x(),   sigma.y(),   sigma.z()};
}

std::optional<MeasurementModel> PerfectVelocityFix(
    const SensorSettings& settings, const Motion& motion) {
  const Eigen::Vector3d v_e =
      motion.v_e +
      motion.q_eb * motion.w_eb_b.cross(settings.sensor.lever_arm_b);
  return VelocityFix{NedAxes(motion.p_e).transpose() * v_e,
                     settings.sigma->cwiseAbs2().asDiagonal()};
}

void DisturbVelocities(const SensorSettings& settings, Random* random,
                       std::vector<Measurement>* measurements) {
  for (Measurement& z : *measurements) {
    std::get<VelocityFix>(z.model).v_n +=
        settings.sigma->cwiseProduct(random->NormalVector3());
  }
}

}  // namespace

const SensorKind& VelocityKind() {
  static const SensorKind kKind = {
      .name = "velocity",
      .help = "velocities over the Earth, north, east, down (GNSS Doppler)",
      .components = {"north", "east", "down"},
      .residual_unit = "m/s",
      .is_velocity = true,
      .moves = true,
      .coloured = Quantity::kSpeed,
      .states_sigma = true,
      .columns = {{"v_n", Quantity::kSpeed},
                  {"v_e", Quantity::kSpeed},
                  {"v_d", Quantity::kSpeed},
                  {"sigma_v_n", Quantity::kSpeed},
                  {"sigma_v_e", Quantity::kSpeed},
                  {"sigma_v_d", Quantity::kSpeed},
                  {"sd_v_ne", Quantity::kSpeed},
                  {"sd_v_ed", Quantity::kSpeed},
                  {"sd_v_dn", Quantity::kSpeed},
                  {"quality", Quantity::kRatio}},
      .measured =
          [](const SensorSettings&) {
            return MeasuredColumns{0, 3, 3};
          },
      .keys = {SigmaKey(Quantity::kSpeed, false,
                        "replaces the file's: one, or north, east, down"),
               LeverArmKey(), LeverArmSigmaKey()},
      .blocks = {LeverArmBlock(), TimeOffsetBlock(),
                 NoiseBlock(BlockKind::kColouredNoise, "m/s")},
      .prepare = [](SensorSettings* s) { s->pattern = VelocityFix(); },
      .read = [](const MeasuredRow& row,
                 const SensorSettings&) -> std::optional<MeasurementModel> {
        return VelocityFix{{row.Value(0), row.Value(1), row.Value(2)},
                           row.Covariance()};
      },
      .written =
          [](const MeasurementModel&, const Sensor&) {
            return std::vector<WrittenColumn>{
                {"v_n", "m/s", 1.0, 8},         {"v_e", "m/s", 1.0, 8},
                {"v_d", "m/s", 1.0, 8},         {"sigma_v_n", "m/s", 1.0, -12},
                {"sigma_v_e", "m/s", 1.0, -12}, {"sigma_v_d", "m/s", 1.0, -12}};
          },
      .write = WriteVelocity,
      .perfect = PerfectVelocityFix,
      .disturb = DisturbVelocities,
  };
  return kKind;
}

}  // namespace hindsight
