#include "measurements/velocity_fix.h"

#include "geometry/so3.h"
#include "measurements/point_motion.h"

namespace hindsight {

void VelocityFix::Evaluate(const ModelContext& context,
                           LinearizedMeasurement* out) const {
  const PointMotion motion = MotionOfSensor(context);
  const Eigen::Matrix3d C_ne = motion.C_en.transpose();
  const Eigen::Vector3d predicted = C_ne * motion.v_e;
  out->Resize(rows(), context.layout.dim());
  out->residual =
      v_n - predicted -
      Parameter3(context.layout, context.state, BlockKind::kColouredNoise,
                 context.sensor_index, Eigen::Vector3d::Zero());
  AddVelocityColumns(context, motion, C_ne, &out->H);
  context.layout.AddColumns(BlockKind::kPosition, BlockKey::kNoSensor,
                            Skew(predicted) * NedTurn(context.state.p_e),
                            &out->H);
  context.layout.AddColumns(BlockKind::kColouredNoise, context.sensor_index,
                            Eigen::Matrix3d::Identity(), &out->H);
  out->R = WhiteCovariance(context, R_n);
}

}  // namespace hindsight
