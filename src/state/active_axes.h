#ifndef HINDSIGHT_STATE_ACTIVE_AXES_H_
#define HINDSIGHT_STATE_ACTIVE_AXES_H_

#include <Eigen/Core>

#include "state/error_layout.h"

namespace hindsight {

/// The components of `block` in d as a full three-component value; masked axes
/// and those beyond FullDimension are zero.
Eigen::Vector3d Expand(const Block& block, const ErrorVector& d);

/// Writes the active axes of `full` to the components of `block` in d.
void Compress(const Block& block, const Eigen::Vector3d& full, ErrorVector* d);

}  // namespace hindsight

#endif  // HINDSIGHT_STATE_ACTIVE_AXES_H_
