#ifndef HINDSIGHT_DATASET_IMU_CELLS_H_
#define HINDSIGHT_DATASET_IMU_CELLS_H_

#include <Eigen/Core>
#include <vector>

#include "dataset/dataset.h"

namespace hindsight {

/// A quarter of a window (StationaryOptions::window) of the IMU's record.
struct ImuCell {
  double begin = 0.0;                           ///< [s]
  double end = 0.0;                             ///< [s]
  Eigen::Vector3d w = Eigen::Vector3d::Zero();  ///< mean reading [rad/s]
  Eigen::Vector3d f = Eigen::Vector3d::Zero();  ///< mean reading [m/s^2]
  /// Number of the span, over which the IMU does not turn, that the cell is
  /// part of; -1: of none, the IMU may turn.
  int span = -1;
  /// It does not turn, and nothing shakes it either.
  bool quiet = false;

  double length() const { return end - begin; }
  double middle() const { return 0.5 * (begin + end); }
};

/// The IMU's record in cells, and where it does not turn, from the IMU alone.
///   not turning  over every window the mean rate is one that the bias may have
///                (five sigmas of the a priori bias, the Earth's rate and what
///                a window tells, each axis) and stays within what it tells of
///                the span's mean: five sigmas of its white noise and of
///                StationaryOptions::rate_sigma; the mean specific force within
///                three times accel_threshold of the span's (its direction does
///                not change), and the standard deviations within ten times the
///                thresholds: an engine may idle, a hand may not move it.
///   quiet        the standard deviations (norm over the axes) within the
///                thresholds, the mean specific force within 3 % of gravity.
/// Whether it moves, smoothly and straight, an IMU alone cannot say. Linear in
/// the number of samples.
std::vector<ImuCell> ExamineImu(const Dataset& dataset);

/// The quiet parts of the record in which the rate alone is more than the bias
/// may have: a turn, or a bias larger than its a priori sigma says.
struct UnexplainedRate {
  double seconds = 0.0;
  double rate = 0.0;  ///< the largest norm of a window's mean [rad/s]
};
UnexplainedRate FindUnexplainedRate(const Dataset& dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_IMU_CELLS_H_
