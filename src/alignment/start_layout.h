#ifndef HINDSIGHT_ALIGNMENT_START_LAYOUT_H_
#define HINDSIGHT_ALIGNMENT_START_LAYOUT_H_

#include <optional>
#include <string>

#include "dataset/bias_sigma.h"
#include "dataset/dataset.h"
#include "state/error_layout.h"

namespace hindsight {

/// The error layout a data set asks for: the navigation blocks and every
/// calibration block with an a priori sigma in its sensor.
ErrorLayout BuildLayout(const Dataset& dataset, const NavigationPrior& prior);

/// The layout's a priori covariance: the blocks' sigmas and, of what earlier
/// recordings say (Dataset::constants), the covariances of one with another.
ErrorMatrix InitialCovariance(const Dataset& dataset,
                              const ErrorLayout& layout);

/// Throws InputError, naming `config` and what each sensor adds, if the data
/// set asks for more than kMaxParameters values beyond the navigation state.
void RequireCapacity(const Dataset& dataset, const std::string& config);

/// A priori values of the layout's parameters: what the data set says of each
/// sensor. A mounting whose yaw is not known to 20 deg starts from the least
/// rotation that turns `travel_b`, the direction of travel in body axes, into
/// the vehicle's forward axis.
ParameterVector InitialParameters(
    const Dataset& dataset, const ErrorLayout& layout,
    const std::optional<Eigen::Vector3d>& travel_b = std::nullopt);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_START_LAYOUT_H_
