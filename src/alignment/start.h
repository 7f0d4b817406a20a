#ifndef HINDSIGHT_ALIGNMENT_START_H_
#define HINDSIGHT_ALIGNMENT_START_H_

#include <string>

#include "alignment/start_layout.h"
#include "base/error.h"
#include "dataset/dataset.h"
#include "dataset/rest.h"
#include "filters/forward_filter.h"

namespace hindsight {

/// How the initial state came about.
struct StartReport {
  double t = 0.0;
  std::string alignment;  ///< name of the method, as in a configuration
  std::string why;        ///< why this method, and what others would give
  std::string position;   ///< in words: "given", "first position fix"
  std::string attitude;   ///< "given", "levelled at rest for 12.3 s", ...
  std::string heading;    ///< "given", "course at t = 31.2 s", ...
  /// As in AlignedAttitude [rad/s/sqrt(s)].
  double gyro_bias_walk = 0.0;
  State state;
  Eigen::Vector3d position_sigma;  ///< NED [m]
  Eigen::Vector3d velocity_sigma;  ///< NED [m/s]
  Eigen::Vector3d attitude_sigma;  ///< roll, pitch, heading [rad]
};

/// The start of an estimation: report in words, layout, prior. The prior is
/// wider than the report where the same measurements are used again.
struct Start {
  StartReport report;
  ErrorLayout layout;
  Prior prior;
  /// Index of the sensor whose fix gave the position and its sigma; -1: given.
  int position_sensor = -1;
};

/// The start for a method that does not take a sensor at its word: if the
/// position is that of its fix, with 1 km added to the sigma of each axis, so
/// that an error which the sensor begins with does not stay for good.
Start WithoutTrustIn(int sensor, Start start);

/// Neither the configuration nor the data say where the data set begins.
class NoInitialPosition : public EstimationError {
 public:
  using EstimationError::EstimationError;
};

/// Finds the initial state of a data set over [from, to].
///   time      given; else the first IMU sample, reached backward from the
///             alignment epoch (ExtendBackward) if nothing gives a position
///             before.
///   position  given, else the first position fix less its lever arm.
///   attitude  as Align finds it.
///   velocity  given, else zero at rest, else from the first fixes.
///   gyro bias mean rate at rest and as given, by their sigmas; else as given.
/// Rest is what FindRest says of data and given velocity.
/// Throws NoInitialPosition if there is no position.
Start FindStart(const Dataset& dataset, double from, double to);
/// The same with what is known of rests.
Start FindStart(const Dataset& dataset, double from, double to,
                const RestMemo& rests);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_START_H_
