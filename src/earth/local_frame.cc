#include "earth/local_frame.h"

#include "earth/wgs84.h"

namespace hindsight {

Eigen::Matrix3d NedFromLevel(FrameAxes axes) {
  Eigen::Matrix3d C_nl = Eigen::Matrix3d::Identity();
  if (axes == FrameAxes::kEnu) C_nl << 0, 1, 0, 1, 0, 0, 0, 0, -1;
  if (axes == FrameAxes::kNwu) C_nl << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  return C_nl;
}

LocalFrame FrameAt(FrameAxes axes, const Eigen::Vector3d& origin_e) {
  if (axes == FrameAxes::kEcef) return {};
  return {origin_e, NedAxes(origin_e) * NedFromLevel(axes)};
}

}  // namespace hindsight
