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

/// A horizontal speed counts as known if its standard deviation is not larger
/// than this [m/s].
inline constexpr double kKnownSpeed = 0.1;

/// Speeds in each of `spans`, which are in time order, of all that is not
/// withheld: slopes of positions and heights, means of velocities, Doppler log
/// (bottom track), odometer, speed and course, zero velocities, and the given
/// initial velocity. Each is as short as makes it known to kKnownSpeed, of
/// positions and heights a second long at least; what a span as a whole does
/// not tell that well comes as it is. In order of `begin`.
std::vector<SpeedEvidence> MeasureSpeeds(
    const Dataset& dataset, const std::vector<TimeInterval>& spans);

/// The aiding of a data set, to be asked for what it says of any time.
class SpeedRecord {
 public:
  /// One measurement of a stream: a place, whose slope is wanted, or a speed.
  struct Reading {
    double begin = 0.0;
    double end = 0.0;  ///< of what has no extension: the same
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
    Eigen::Vector3d sigma = Eigen::Vector3d::Zero();
  };
  /// The readings of one stream, in time order.
  struct Readings {
    bool are_places = false;
    NoiseModel noise;  ///< what lasts, beside each reading's own sigma
    std::vector<Reading> all;
  };

  explicit SpeedRecord(const Dataset& dataset);

  const std::vector<Readings>& streams() const { return streams_; }
  /// The mean velocity over `span` by each stream that measures in it: the
  /// least-squares slope of places over a second at least, or the mean of
  /// speeds.
  std::vector<SpeedEvidence> Over(const TimeInterval& span) const;

 private:
  std::vector<Readings> streams_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_SPEED_EVIDENCE_H_
