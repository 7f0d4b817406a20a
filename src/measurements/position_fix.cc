#include "measurements/position_fix.h"

#include "earth/wgs84.h"
#include "measurements/point_motion.h"

namespace hindsight {

void PositionFix::Evaluate(const ModelContext& context,
                           LinearizedMeasurement* out) const {
  const PointMotion motion = MotionOfSensor(context);
  const Eigen::Matrix3d C_ne = NedAxes(p_e).transpose();
  out->Resize(rows(), context.layout.dim());
  out->residual =
      C_ne * (p_e - motion.p_e) -
      Parameter3(context.layout, context.state, BlockKind::kColouredNoise,
                 context.sensor_index, Eigen::Vector3d::Zero());
  AddPositionColumns(context, motion, C_ne, &out->H);
  context.layout.AddColumns(BlockKind::kColouredNoise, context.sensor_index,
                            Eigen::Matrix3d::Identity(), &out->H);
  out->R = WhiteCovariance(context, R_n);
}

}  // namespace hindsight
