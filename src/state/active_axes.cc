#include "state/active_axes.h"

namespace hindsight {

Eigen::Vector3d Expand(const Block& block, const ErrorVector& d) {
  Eigen::Vector3d full = Eigen::Vector3d::Zero();
  int component = block.offset;
  const int dim = FullDimension(block.key.kind);
  for (int axis = 0; axis < dim; ++axis) {
    if (block.active[static_cast<std::size_t>(axis)]) {
      full(axis) = d(component++);
    }
  }
  return full;
}

void Compress(const Block& block, const Eigen::Vector3d& full, ErrorVector* d) {
  int component = block.offset;
  const int dim = FullDimension(block.key.kind);
  for (int axis = 0; axis < dim; ++axis) {
    if (block.active[static_cast<std::size_t>(axis)]) {
      (*d)(component++) = full(axis);
    }
  }
}

}  // namespace hindsight
