#ifndef HINDSIGHT_SIMULATION_BAD_START_H_
#define HINDSIGHT_SIMULATION_BAD_START_H_

#include <cstdint>

#include "dataset/dataset.h"

namespace hindsight {

/// A bad start: size of the initial attitude error, drawn in direction alone.
struct BadStart {
  double tilt = 0.0;     ///< about a level axis of any direction [rad]
  double heading = 0.0;  ///< to either side [rad]
};

/// Gives a simulated data set the initial attitude
///   C_nb^ = Exp(-(tilt axis) tilt) Exp(-(+-heading) down) C_nb
/// of its first truth point, with attitude sigmas (tilt, tilt, heading), and
/// the first measured velocity with its sigma. Throws InputError where none is
/// measured.
void GiveBadStart(const BadStart& start, std::uint64_t seed, Dataset* dataset);

/// Turns the IMU in the aircraft of a simulated data set, at an attitude drawn
/// evenly from all rotations: its axes, the truth and the biases with them.
void MountAnywhere(std::uint64_t seed, Dataset* dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_SIMULATION_BAD_START_H_
