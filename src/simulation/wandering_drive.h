#ifndef HINDSIGHT_SIMULATION_WANDERING_DRIVE_H_
#define HINDSIGHT_SIMULATION_WANDERING_DRIVE_H_

#include <cstdint>
#include <vector>

#include "simulation/motion_profile.h"

namespace hindsight {

/// A drive through town and country of at least `duration` [s], from and to no
/// particular place: speeds up to 20 m/s, turns, slopes, stops, drawn from the
/// seed. Lateral acceleration stays below 3 m/s^2.
std::vector<Segment> WanderingDrive(double duration, std::uint64_t seed);

}  // namespace hindsight

#endif  // HINDSIGHT_SIMULATION_WANDERING_DRIVE_H_
