#ifndef HINDSIGHT_DATASET_FIELD_WINDOWS_H_
#define HINDSIGHT_DATASET_FIELD_WINDOWS_H_

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "dataset/dataset.h"

namespace hindsight {

/// Ways in which the axes of a magnetometer may be arranged otherwise than they
/// are taken to be: row i is the signed axis that is read as axis i. All 48, left-
/// and right-handed; the first is none of them changed.
inline constexpr std::size_t kAxisArrangements = 48;
const std::array<Eigen::Matrix3d, kAxisArrangements>& AxisArrangements();

/// How a magnetometer's readings fare under each arrangement, on average over
/// windows of 10 s, which the gyros turn back to their begin.
struct ArrangementCosts {
  /// Mean squared norm about the mean over the mean squared norm, of windows
  /// with turns of more than 20 deg.
  std::array<double, kAxisArrangements> scatter = {};
  /// Sine of the dip against the mean specific force.
  std::array<double, kAxisArrangements> dip_sine = {};
  int turned = 0;     ///< windows with a turn
  double norm = 0.0;  ///< root mean square [uT]
};

/// The costs of a stream of magnetic fields, from which the hard iron is taken
/// off, over at most 60 windows inside the IMU's record.
ArrangementCosts ReadFieldWindows(const Dataset& dataset,
                                  const AidingStream& stream);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_FIELD_WINDOWS_H_
