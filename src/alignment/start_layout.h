#ifndef HINDSIGHT_ALIGNMENT_START_LAYOUT_H_
#define HINDSIGHT_ALIGNMENT_START_LAYOUT_H_

#include "dataset/dataset.h"
#include "state/error_layout.h"

namespace hindsight {

/// The error layout a data set asks for: the navigation blocks and every
/// calibration block with an a priori sigma in its sensor.
ErrorLayout BuildLayout(const Dataset& dataset, const NavigationPrior& prior);

/// A priori values of the layout's parameters: what the data set says of each
/// sensor.
ParameterVector InitialParameters(const Dataset& dataset,
                                  const ErrorLayout& layout);

/// A priori standard deviations of the biases: as given, or those of a consumer
/// IMU straight from power-up, 0.2 deg/s and 0.2 m/s^2.
Eigen::Vector3d GyroBiasSigma(const InitialState& given);
Eigen::Vector3d AccelBiasSigma(const InitialState& given);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_START_LAYOUT_H_
