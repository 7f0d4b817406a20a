#include "measurements/model.h"

namespace hindsight {

Eigen::Matrix3d WhiteCovariance(const ModelContext& context,
                                const Eigen::Matrix3d& R) {
  const Block* block =
      context.layout.Find(BlockKind::kColouredNoise, context.sensor_index);
  const NoiseModel& noise = context.sensor.noise;
  if (block == nullptr || !noise.correlated()) return R;
  Eigen::Matrix3d white = R;
  for (int axis = 0; axis < 3; ++axis) {
    if (!block->active[static_cast<std::size_t>(axis)]) continue;
    white.row(axis).setZero();
    white.col(axis).setZero();
    white(axis, axis) = noise.white_sigma * noise.white_sigma;
  }
  return white;
}

}  // namespace hindsight
