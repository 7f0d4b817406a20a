#include "measurements/height_fix.h"

#include "earth/wgs84.h"
#include "measurements/point_motion.h"

namespace hindsight {

void HeightFix::Evaluate(const ModelContext& context,
                         LinearizedMeasurement* out) const {
  const PointMotion motion = MotionOfSensor(context);
  const Geodetic g = GeodeticFromEcef(motion.p_e);
  const Eigen::RowVector3d up_e =
      -NedAxes(g.latitude, g.longitude).col(2).transpose();
  out->Resize(rows(), context.layout.dim());
  out->residual(0) = height - g.height -
                     Parameter1(context.layout, context.state,
                                BlockKind::kOffset, context.sensor_index, 0.0);
  AddPositionColumns(context, motion, up_e, &out->H);
  context.layout.AddColumns(BlockKind::kOffset, context.sensor_index,
                            Eigen::Matrix<double, 1, 1>::Identity(), &out->H);
  const NoiseModel& noise = context.sensor.noise;
  const bool coloured =
      noise.kind == NoiseModel::Kind::kGaussMarkov &&
      context.layout.Has(BlockKind::kOffset, context.sensor_index);
  const double white = coloured ? noise.white_sigma : sigma;
  out->R(0, 0) = white * white;
}

}  // namespace hindsight
