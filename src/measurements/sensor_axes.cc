#include "measurements/sensor_axes.h"

#include "geometry/so3.h"

namespace hindsight {

SensorAxes AxesOfSensor(const ModelContext& context,
                        const PointMotion& motion) {
  SensorAxes axes;
  axes.m = Parameter3(context.layout, context.state, BlockKind::kMounting,
                      context.sensor_index, Eigen::Vector3d::Zero());
  axes.C_sb = (Exp(axes.m) * context.sensor.q_sb).toRotationMatrix();
  axes.C_se = axes.C_sb * motion.C_eb.transpose();
  return axes;
}

void AddAxesColumns(const ModelContext& context, const PointMotion& motion,
                    const SensorAxes& axes, const Eigen::Vector3d& u_e,
                    const RowTimes3& A, RowJacobian* H) {
  const ErrorLayout& layout = context.layout;
  const int sensor = context.sensor_index;
  const Eigen::Vector3d u_s = axes.C_se * u_e;
  const RowTimes3 A_e = A * axes.C_se;
  layout.AddColumns(BlockKind::kAttitude, BlockKey::kNoSensor,
                    A_e * Skew(u_e) * motion.C_en, H);
  const Eigen::Vector3d u_b = motion.C_eb.transpose() * u_e;
  layout.AddColumns(BlockKind::kTimeOffset, sensor,
                    -A * (axes.C_sb * motion.w_eb_b.cross(u_b)), H);
  layout.AddColumns(BlockKind::kMounting, sensor,
                    -A * Skew(u_s) * LeftJacobian(axes.m), H);
}

void AddSensorVelocityColumns(const ModelContext& context,
                              const PointMotion& motion, const SensorAxes& axes,
                              const RowTimes3& A, RowJacobian* H) {
  AddVelocityColumns(context, motion, A * axes.C_se, H);
  AddAxesColumns(context, motion, axes, motion.v_e, A, H);
}

}  // namespace hindsight
