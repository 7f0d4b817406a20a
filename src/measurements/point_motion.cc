#include "measurements/point_motion.h"

#include <cmath>

#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "imu/imu_link.h"

namespace hindsight {

PointMotion MotionOfSensor(const ModelContext& context) {
  const State& x = context.state;
  const ImuCalibration calibration = CalibrationOf(context.layout, x);
  PointMotion m;
  m.C_en = x.C_en();
  m.C_eb = x.q_eb.toRotationMatrix();
  m.l_b = Parameter3(context.layout, x, BlockKind::kLeverArm,
                     context.sensor_index, context.sensor.lever_arm_b);
  m.w_ib_b = (context.kinematics.w_ib_b - calibration.b_g).array() /
             (1.0 + calibration.s_g.array());
  m.w_eb_b = m.w_ib_b - m.C_eb.transpose() * EarthRate_e();
  m.p_e = x.p_e + m.C_eb * m.l_b;
  m.v_e = x.v_e + m.C_eb * m.w_eb_b.cross(m.l_b);
  m.a_e.setZero();
  if (context.layout.Has(BlockKind::kTimeOffset, context.sensor_index)) {
    const Eigen::Vector3d f_b =
        (context.kinematics.f_b - calibration.b_a).array() /
        (1.0 + calibration.s_a.array());
    m.a_e = m.C_eb * (f_b + m.w_eb_b.cross(m.w_eb_b.cross(m.l_b))) +
            Gravity(x.p_e) - 2.0 * EarthRate_e().cross(x.v_e);
  }
  return m;
}

void AddBodyRateColumns(const ModelContext& context, const PointMotion& m,
                        const RowTimes3& A, RowJacobian* H) {
  const ErrorLayout& layout = context.layout;
  const int none = BlockKey::kNoSensor;
  const ImuCalibration calibration = CalibrationOf(layout, context.state);
  const Eigen::Vector3d factor = 1.0 / (1.0 + calibration.s_g.array());
  layout.AddColumns(BlockKind::kAttitude, none,
                    -A * m.C_eb.transpose() * Skew(EarthRate_e()) * m.C_en, H);
  layout.AddColumns(BlockKind::kGyroBias, none, -A * factor.asDiagonal(), H);
  layout.AddColumns(BlockKind::kGyroScale, none,
                    -A * m.w_ib_b.cwiseProduct(factor).asDiagonal(), H);
}

void AddPositionColumns(const ModelContext& context, const PointMotion& m,
                        const RowTimes3& A, RowJacobian* H) {
  const ErrorLayout& layout = context.layout;
  const int none = BlockKey::kNoSensor;
  layout.AddColumns(BlockKind::kPosition, none, A * m.C_en, H);
  layout.AddColumns(BlockKind::kAttitude, none,
                    -A * Skew(m.C_eb * m.l_b) * m.C_en, H);
  layout.AddColumns(BlockKind::kLeverArm, context.sensor_index, A * m.C_eb, H);
  layout.AddColumns(BlockKind::kTimeOffset, context.sensor_index, A * m.v_e, H);
}

void AddVelocityColumns(const ModelContext& context, const PointMotion& m,
                        const RowTimes3& A, RowJacobian* H) {
  const ErrorLayout& layout = context.layout;
  const int none = BlockKey::kNoSensor;
  const RowTimes3 A_b = A * m.C_eb;
  layout.AddColumns(BlockKind::kVelocity, none, A * m.C_en, H);
  layout.AddColumns(BlockKind::kAttitude, none,
                    -A * Skew(m.C_eb * m.w_eb_b.cross(m.l_b)) * m.C_en, H);
  AddBodyRateColumns(context, m, -A_b * Skew(m.l_b), H);
  layout.AddColumns(BlockKind::kLeverArm, context.sensor_index,
                    A_b * Skew(m.w_eb_b), H);
  layout.AddColumns(BlockKind::kTimeOffset, context.sensor_index, A * m.a_e, H);
}

Eigen::Matrix3d NedTurn(const Eigen::Vector3d& p_e) {
  const Geodetic g = GeodeticFromEcef(p_e);
  const double R_t = TransverseRadius(g.latitude) + g.height;
  const double R_m = MeridianRadius(g.latitude) + g.height;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
  turn(0, 1) = 1.0 / R_t;
  turn(1, 0) = -1.0 / R_m;
  // The axes spin without bound as a pole is approached; there the term is
  // left out, which only slows convergence.
  const double tan_latitude = std::tan(g.latitude);
  if (std::abs(tan_latitude) < 1e5) turn(2, 1) = -tan_latitude / R_t;
  return turn;
}

}  // namespace hindsight
