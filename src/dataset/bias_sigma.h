#ifndef HINDSIGHT_DATASET_BIAS_SIGMA_H_
#define HINDSIGHT_DATASET_BIAS_SIGMA_H_

#include <Eigen/Core>

#include "dataset/dataset.h"

namespace hindsight {

/// A priori standard deviations of the biases: as given, or those of a consumer
/// IMU straight from power-up, 0.2 deg/s and 0.2 m/s^2.
Eigen::Vector3d GyroBiasSigma(const InitialState& given);
Eigen::Vector3d AccelBiasSigma(const InitialState& given);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_BIAS_SIGMA_H_
