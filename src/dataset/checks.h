#ifndef HINDSIGHT_DATASET_CHECKS_H_
#define HINDSIGHT_DATASET_CHECKS_H_

#include <optional>
#include <string>
#include <vector>

#include "dataset/dataset.h"
#include "dataset/imu_report.h"
#include "state/evidence.h"

namespace hindsight {

/// An interval without rows, longer than three median intervals and 0.1 s.
struct StreamGap {
  double t = 0.0;       ///< of the row before [s]
  double length = 0.0;  ///< [s]
};

/// What the stamps of one stream say. Times are in the IMU's clock: an aiding
/// sensor's time offset is applied.
struct StreamReport {
  std::string name;
  long count = 0;
  double t_begin = 0.0;  ///< [s]
  double t_end = 0.0;    ///< [s]
  double rate = 0.0;     ///< one over the median interval [Hz]
  double jitter = 0.0;   ///< standard deviation of intervals without gaps [s]
  /// The same standard deviation [s], but two neighbouring intervals that add
  /// up to the median one are counted as one interval: a file may hold extra
  /// rows between its regular ones, which says nothing against the stamps.
  double delay = 0.0;
  long duplicates = 0;  ///< rows with the stamp of the row before
  std::vector<StreamGap> gaps;
  double overlap = 0.0;  ///< with the IMU [s]
};

struct CheckReport {
  std::vector<StreamReport> streams;  ///< imu, aiding, truth
  ImuReport imu;
  /// One line each: what looks wrong, and what would put it right.
  std::vector<std::string> warnings;
  /// Likewise of the truth, which no grade depends on.
  std::vector<std::string> truth_warnings;
  /// What readings that are repeated in every digit say of the recording
  /// (dataset/repeated_readings.h).
  std::vector<Evidence> evidence;
  /// In words, from the axis that feels gravity where the vehicle does not
  /// turn, or on average where that is most of what it feels: "z points down, as
  /// it should", or the `axes` that would make it so.
  std::string axes;
  /// Those `axes`, "[x, -y, -z]"; empty where z points down.
  std::string suggested_axes;

  /// Not usable: no IMU. Otherwise the worst of the evidence; doubtful where
  /// there are warnings.
  Grade grade() const;
};

/// Examines a data set and changes nothing. Thresholds: |f| at rest within 5 %
/// of 9.81 m/s^2, without a rest within 20 % where it varies least, |w| at rest
/// within 2 deg/s of the given bias, |f| below 200 m/s^2, |w| below 35 rad/s,
/// delays of stamps below a fifth of the interval: those make one interval
/// longer and the next shorter, where rows between the regular ones make them
/// only shorter. Rest is what FindRest says; an IMU that is quiet, but only
/// while it turns faster than its gyro bias may be, is warned of.
/// Magnetometers: see CheckMagnetometers.
CheckReport CheckDataset(const Dataset& dataset);

/// The same but for `evidence`, which whoever solves the recording finds for the
/// interval that is solved.
CheckReport DescribeDataset(const Dataset& dataset, const RestMemo& rests);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_CHECKS_H_
