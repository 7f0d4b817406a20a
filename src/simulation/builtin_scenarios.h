#ifndef HINDSIGHT_SIMULATION_BUILTIN_SCENARIOS_H_
#define HINDSIGHT_SIMULATION_BUILTIN_SCENARIOS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/scenario.h"

namespace hindsight {

/// Names of the scenarios that come with the program:
///   car_drive    30 min at 200 Hz, tactical IMU, GNSS 5/5/10 cm at 1 Hz, three
///                outages of 60 s
///   short_drive  3 min at 100 Hz from standstill, GNSS position and velocity
///   flight       10 min at 100 Hz, climbs and banked turns, GNSS position
///   tunnel_survey  8 km in 2005 s at 100 Hz, odometer and reference points
///                  (simulation/tunnel_survey.h, with its default options)
///   in_flight_alignment  150 s at 100 Hz, velocity at 10 Hz, no attitude
///                  (simulation/in_flight_alignment.h, default options)
std::vector<std::string> BuiltinScenarioNames();

/// Throws InputError for a name that is none, listing those that are.
Scenario BuiltinScenario(const std::string& name);

/// A drive through town and country of at least `duration` [s], from and to no
/// particular place: speeds up to 20 m/s, turns, slopes, stops, drawn from the
/// seed. Lateral acceleration stays below 3 m/s^2.
std::vector<Segment> WanderingDrive(double duration, std::uint64_t seed);

}  // namespace hindsight

#endif  // HINDSIGHT_SIMULATION_BUILTIN_SCENARIOS_H_
