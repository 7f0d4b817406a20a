#ifndef HINDSIGHT_ALIGNMENT_MOUNTING_SEARCH_H_
#define HINDSIGHT_ALIGNMENT_MOUNTING_SEARCH_H_

#include <Eigen/Geometry>
#include <optional>

#include "dataset/dataset.h"

namespace hindsight {

/// A first value of how the IMU sits in a vehicle that runs forward.
struct FoundMounting {
  Eigen::Quaterniond q_ob;  ///< vehicle (forward, right, down) from body axes
  double yaw_sigma = 0.0;   ///< from the misfit [rad]
  double lag = 0.0;         ///< of the velocities behind the IMU [s]
};

/// Compares what the accelerometers feel with how the ground velocity changes.
/// Over each second or so of motion above 2 m/s,
///   f_b = C_bo (a_o - g_o),
/// a_o the mean acceleration along and across the course, g_o = (0, 0, g): the
/// vehicle is taken as level and moving forward, which is right on average. The
/// rotation that fits all these pairs best is Wahba's (1965), solved by
/// Kabsch's singular value decomposition: gravity decides roll and pitch,
/// braking, starting and turning decide yaw, and the course which end is the
/// front. The clocks may differ: the lag of the best fit within 1 s is taken.
/// Nothing is found if that explains less than half of the horizontal
/// acceleration, or tells yaw no better than to 15 deg.
std::optional<FoundMounting> FindMounting(const Dataset& dataset, double from,
                                          double to);

/// Puts what FindMounting says into every odometer or non-holonomic stream
/// whose mounting is unknown or has an a priori sigma above 15 deg, and into
/// the streams that speak of its vehicle; their a priori sigmas stay, but are
/// at most 10 deg. Leaves a note in the data set. Throws EstimationError if a
/// mounting is unknown and nothing is found.
void ResolveMountings(Dataset* dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_MOUNTING_SEARCH_H_
