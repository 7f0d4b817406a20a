#ifndef HINDSIGHT_DATASET_SPEED_EVIDENCE_H_
#define HINDSIGHT_DATASET_SPEED_EVIDENCE_H_

#include <Eigen/Core>
#include <vector>

#include "dataset/dataset.h"
#include "dataset/time_interval.h"

namespace hindsight {

/// What one aiding sensor says of the mean velocity over a span in which the
/// vehicle does not turn: a lever arm then adds nothing, and axes fixed in the
/// vehicle are as good as those of the Earth.
struct SpeedEvidence {
  int span = -1;       ///< number of that span; -1: of an instant outside all
  double begin = 0.0;  ///< true time of the first measurement [s]
  double end = 0.0;    ///< and of the last
  /// Axes of the sensor, two horizontal and one vertical [m/s].
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  /// Standard deviation of each; infinite where nothing is measured.
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();

  /// Horizontal, the worse axis.
  double horizontal_sigma() const { return sigma.head<2>().maxCoeff(); }
};

/// A horizontal speed is known that is known to this, one sigma [m/s].
inline constexpr double kKnownSpeed = 0.1;

/// Speeds in each of `spans`, which are in time order, of all that is not
/// withheld: slopes of positions and heights, means of velocities, Doppler log
/// (bottom track), odometer, speed and course, zero velocities, and the given
/// initial velocity. Each is as short as makes it known to kKnownSpeed, of
/// positions and heights a second long at least; what a span as a whole does
/// not tell that well comes as it is. In order of `begin`.
std::vector<SpeedEvidence> MeasureSpeeds(
    const Dataset& dataset, const std::vector<TimeInterval>& spans);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_SPEED_EVIDENCE_H_
