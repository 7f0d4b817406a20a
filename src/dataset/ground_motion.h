#ifndef HINDSIGHT_DATASET_GROUND_MOTION_H_
#define HINDSIGHT_DATASET_GROUND_MOTION_H_

#include <optional>
#include <vector>

#include "dataset/dataset.h"

namespace hindsight {

/// A position fix at its true time, withheld ones left out.
struct TimedFix {
  double t = 0.0;
  Eigen::Vector3d p_e;
  Eigen::Matrix3d R_n;  ///< [m^2]
  double sigma = 0.0;   ///< horizontal, an axis [m]
  int sensor = 0;
};

/// Fixes of all position streams in [from, to], in time order.
std::vector<TimedFix> PositionFixes(const Dataset& dataset, double from,
                                    double to);

/// Velocity over the ground of a moment, with its standard deviation an axis.
struct TimedVelocity {
  double t = 0.0;
  Eigen::Vector3d v_n;  ///< [m/s]
  double sigma = 0.0;
};

/// Measured velocities in [from, to]; without a velocity stream, differences of
/// position fixes over so long that 0.3 m/s stands above their noise (at most
/// 5 s).
std::vector<TimedVelocity> GroundVelocities(const Dataset& dataset, double from,
                                            double to);

/// Velocity of a Doppler log's transducer over the bottom, body axes [m/s], as
/// the told scale and boresight have it, with its standard deviation an axis.
struct BottomVelocity {
  double t = 0.0;
  Eigen::Vector3d v_b;
  double sigma = 0.0;
};

/// Of one measurement, at its true time t; nothing of water track, nor where
/// less than three components were received.
std::optional<BottomVelocity> BottomVelocityOf(const Dvl& dvl,
                                               const Sensor& sensor, double t);

/// Those of all bottom-tracking logs in [from, to], in time order.
std::vector<BottomVelocity> BottomVelocities(const Dataset& dataset,
                                             double from, double to);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_GROUND_MOTION_H_
