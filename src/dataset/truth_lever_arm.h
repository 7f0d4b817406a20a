#ifndef HINDSIGHT_DATASET_TRUTH_LEVER_ARM_H_
#define HINDSIGHT_DATASET_TRUTH_LEVER_ARM_H_

#include <Eigen/Core>
#include <optional>

#include "dataset/dataset.h"

namespace hindsight {

/// The point that a truth speaks of, in body axes from the IMU.
struct TruthLeverArm {
  Eigen::Vector3d l_b = Eigen::Vector3d::Zero();    ///< [m]
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();  ///< an axis [m]
};

/// Finds it by least squares from truth points i, j of at most 2 s apart that
/// have position, velocity and attitude. What the velocity gains beyond what the
/// accelerometers feel is that of the point against the IMU:
///   C_i' (v_j - v_i - (g - 2 w_ie x v_i) dt) - dv = C_ij (w_j x l) - w_i x l - b dt,
/// with dv of the IMU's summary, C_ij by the truth, w the IMU's rates less its
/// initial bias, and b a constant accelerometer bias; l is 0 +- 3 m beforehand.
/// Sigmas are from the residuals. Nothing where fewer than 20 pairs are there.
std::optional<TruthLeverArm> FindTruthLeverArm(const Dataset& dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_TRUTH_LEVER_ARM_H_
