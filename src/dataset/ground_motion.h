#ifndef HINDSIGHT_DATASET_GROUND_MOTION_H_
#define HINDSIGHT_DATASET_GROUND_MOTION_H_

#include <vector>

#include "dataset/dataset.h"
#include "dataset/standstill.h"

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

/// Those of all bottom-tracking logs in [from, to], in time order. Beams give
/// one where three were received.
std::vector<BottomVelocity> BottomVelocities(const Dataset& dataset,
                                             double from, double to);

/// Spans in which the vehicle stands, in time order: what FindStandstill says,
/// less every second in which GNSS or a Doppler log sees motion (even cruise on
/// a good road, in still air or under water looks like rest to an IMU), and
/// every span of at least 3 s in which GNSS sees none (an idling engine shakes
/// an IMU): speeds below 0.1 m/s and twice their sigma, known to 0.1 m/s,
/// without gaps.
std::vector<TimeInterval> FindRests(const Dataset& dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_GROUND_MOTION_H_
