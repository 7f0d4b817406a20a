#ifndef HINDSIGHT_SIMULATION_FREE_ROTATION_H_
#define HINDSIGHT_SIMULATION_FREE_ROTATION_H_

#include <Eigen/Core>
#include <cstdint>

#include "dataset/dataset.h"

namespace hindsight {

/// Name of the scenario in `hindsight montecarlo`.
inline constexpr char kFreeRotationName[] = "free_rotation";

/// A body in the hand that rests for 15 s, makes 20 net turns about the
/// vertical in 60 s, nodding by 0.5 rad, and rests for 15 s, sampled at 100 Hz:
/// gyros of 1e-3 rad/s, accelerometers of 0.05 m/s^2 a sample.
struct FreeRotationOptions {
  Eigen::Vector3d gyro_scale = Eigen::Vector3d::Zero();  ///< [1]
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();   ///< [rad/s]
  Eigen::Vector3d rest_field_n = {20.0, 0.0, 40.0};      ///< [uT]
  Eigen::Vector3d motion_field_n = {20.0, 0.0, 40.0};    ///< [uT]
  double magnetic_noise = 0.5;  ///< of a sample, per axis [uT]
  /// Of every sample in motion in place of the field and its noise [uT]; 0:
  /// there is none.
  double motion_disturbance = 0.0;
};

inline constexpr double kFreeRotationBegin = 15.0;  // of the motion [s]
inline constexpr double kFreeRotationEnd = 75.0;    // [s]

/// One realisation: rates, field (the first stream), truth with attitude and
/// gyro bias at every sample. No place: the Earth does not turn.
Dataset SimulateFreeRotation(const FreeRotationOptions& options,
                             std::uint64_t seed);

/// Options with scale factors of 0.4 % and biases of 0.005 rad/s drawn for the
/// seed.
FreeRotationOptions DrawFreeRotation(std::uint64_t seed);

}  // namespace hindsight

#endif  // HINDSIGHT_SIMULATION_FREE_ROTATION_H_
