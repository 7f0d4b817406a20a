#include "measurements/magnetic_field.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "geometry/so3.h"
#include "measurements/point_motion.h"

namespace hindsight {

Eigen::Vector3d UndisturbedField(const MagneticSurroundings& magnetic,
                                 double declination) {
  return {magnetic.horizontal * std::cos(declination),
          magnetic.horizontal * std::sin(declination), magnetic.down};
}

const Block* OwnFieldOf(const ErrorLayout& layout, int sensor) {
  const Block* block = layout.Find(BlockKind::kHardIron, sensor);
  return block != nullptr && block->dim == 3 ? block : nullptr;
}

double HorizontalSquare(const Eigen::Vector3d& u_n) {
  constexpr double kFloor = 0.01;  // [uT^2]
  return std::max(u_n.head<2>().squaredNorm(), kFloor);
}

namespace {

/// What both forms share: the field around the vehicle and the vehicle's.
struct FieldScene {
  PointMotion motion;
  Eigen::Matrix3d C_nb;
  Eigen::Vector3d m_n;          ///< with the disturbance
  Eigen::Vector3d dm_n_dD;      ///< derivative by the declination
  Eigen::Vector3d hard_iron_b;  ///< with an error that is such a field
  bool has_own_error = false;
};

/// Whether an error of the sensor is a field of the vehicle: of all three axes, or
/// where such a field is estimated.
bool HasOwnError(const MagneticField& z, const ModelContext& context) {
  return context.layout.Has(BlockKind::kSensorError, context.sensor_index) &&
         (z.form == MagneticField::Form::kVector ||
          OwnFieldOf(context.layout, context.sensor_index) != nullptr);
}

FieldScene SceneOf(const MagneticField& z, const ModelContext& context) {
  const MagneticSurroundings& magnetic = context.sensor.magnetic;
  const int sensor = context.sensor_index;
  FieldScene scene;
  scene.motion = MotionOfSensor(context);
  scene.C_nb = scene.motion.C_en.transpose() * scene.motion.C_eb;
  const double declination =
      Parameter1(context.layout, context.state, BlockKind::kDeclination, sensor,
                 magnetic.declination);
  const Eigen::Vector3d undisturbed = UndisturbedField(magnetic, declination);
  scene.dm_n_dD = {-undisturbed.y(), undisturbed.x(), 0.0};
  scene.m_n = undisturbed + Parameter3(context.layout, context.state,
                                       BlockKind::kDisturbance, sensor,
                                       Eigen::Vector3d::Zero());
  scene.hard_iron_b =
      Parameter3(context.layout, context.state, BlockKind::kHardIron, sensor,
                 magnetic.hard_iron_b);
  scene.has_own_error = HasOwnError(z, context);
  if (scene.has_own_error) {
    scene.hard_iron_b +=
        Parameter3(context.layout, context.state, BlockKind::kSensorError,
                   sensor, Eigen::Vector3d::Zero());
  }
  return scene;
}

void EvaluateVector(const MagneticField& z, const ModelContext& context,
                    LinearizedMeasurement* out) {
  const FieldScene scene = SceneOf(z, context);
  const Eigen::Matrix3d C_bn = scene.C_nb.transpose();
  const Eigen::Vector3d m_b = C_bn * scene.m_n;
  out->Resize(3, context.layout.dim());
  out->residual = z.field_b - m_b - scene.hard_iron_b;
  const Eigen::Matrix3d by_psi = C_bn * Skew(scene.m_n);
  const ErrorLayout& layout = context.layout;
  layout.AddColumns(BlockKind::kAttitude, BlockKey::kNoSensor, by_psi, &out->H);
  layout.AddColumns(BlockKind::kPosition, BlockKey::kNoSensor,
                    -by_psi * NedTurn(context.state.p_e), &out->H);
  layout.AddColumns(BlockKind::kTimeOffset, context.sensor_index,
                    m_b.cross(scene.motion.w_eb_b), &out->H);
  layout.AddColumns(BlockKind::kHardIron, context.sensor_index,
                    Eigen::Matrix3d::Identity(), &out->H);
  if (scene.has_own_error) {
    layout.AddColumns(BlockKind::kSensorError, context.sensor_index,
                      Eigen::Matrix3d::Identity(), &out->H);
  }
  layout.AddColumns(BlockKind::kDisturbance, context.sensor_index, C_bn,
                    &out->H);
  layout.AddColumns(BlockKind::kDeclination, context.sensor_index,
                    C_bn * scene.dm_n_dD, &out->H);
  out->R.diagonal().setConstant(z.sigma * z.sigma);
}

/// Derivative of the azimuth of v by v.
Eigen::RowVector3d AzimuthGradient(const Eigen::Vector3d& v) {
  const double h2 = HorizontalSquare(v);
  return {-v.y() / h2, v.x() / h2, 0.0};
}

void EvaluateHeading(const MagneticField& z, const ModelContext& context,
                     LinearizedMeasurement* out) {
  const FieldScene scene = SceneOf(z, context);
  const ErrorLayout& layout = context.layout;
  const Eigen::Vector3d own_b = z.field_b - scene.hard_iron_b;
  const Eigen::Vector3d u_n = scene.C_nb * own_b;
  out->Resize(1, layout.dim());
  out->residual(0) = std::remainder(
      std::atan2(scene.m_n.y(), scene.m_n.x()) - std::atan2(u_n.y(), u_n.x()),
      2.0 * kPi);
  const Eigen::RowVector3d by_u = AzimuthGradient(u_n);
  const Eigen::RowVector3d by_m = AzimuthGradient(scene.m_n);
  const Eigen::RowVector3d by_psi = AzimuthByPsi(u_n);
  layout.AddColumns(BlockKind::kAttitude, BlockKey::kNoSensor, by_psi, &out->H);
  layout.AddColumns(BlockKind::kPosition, BlockKey::kNoSensor,
                    -by_psi * NedTurn(context.state.p_e), &out->H);
  layout.AddColumns(BlockKind::kTimeOffset, context.sensor_index,
                    by_u * scene.C_nb * scene.motion.w_eb_b.cross(own_b),
                    &out->H);
  const Eigen::RowVector3d by_own = -by_u * scene.C_nb;
  layout.AddColumns(BlockKind::kHardIron, context.sensor_index, by_own,
                    &out->H);
  if (scene.has_own_error) {
    layout.AddColumns(BlockKind::kSensorError, context.sensor_index, by_own,
                      &out->H);
  } else if (const Block* error =
                 layout.Find(BlockKind::kSensorError, context.sensor_index);
             error != nullptr) {
    out->residual(0) = std::remainder(
        out->residual(0) - context.state.parameters(error->parameter_offset),
        2.0 * kPi);
    out->H(0, error->offset) = 1.0;
  }
  layout.AddColumns(BlockKind::kDisturbance, context.sensor_index, -by_m,
                    &out->H);
  layout.AddColumns(BlockKind::kDeclination, context.sensor_index,
                    -by_m * scene.dm_n_dD, &out->H);
  out->R(0, 0) = z.sigma * z.sigma / HorizontalSquare(scene.m_n);
}

}  // namespace

Eigen::RowVector3d AzimuthByPsi(const Eigen::Vector3d& u_n) {
  return -AzimuthGradient(u_n) * Skew(u_n);
}

void MagneticField::Evaluate(const ModelContext& context,
                             LinearizedMeasurement* out) const {
  if (form == Form::kVector) {
    EvaluateVector(*this, context, out);
  } else {
    EvaluateHeading(*this, context, out);
  }
}

}  // namespace hindsight
