#ifndef HINDSIGHT_SIMULATION_IN_FLIGHT_ALIGNMENT_H_
#define HINDSIGHT_SIMULATION_IN_FLIGHT_ALIGNMENT_H_

#include <cstdint>

#include "simulation/scenario.h"

namespace hindsight {

/// An aircraft whose attitude is lost in flight. 150 s at 150 m/s: 10 s
/// straight; from then on every 30 s a turn of 20 s at 35 deg of bank, right
/// and left in turn, and between the turns throttle changes of 15 to 20 m/s.
/// IMU at 100 Hz with 3 deg/h, 0.1 deg/sqrt(h), 1 mg and 100 ug/sqrt(Hz);
/// velocity fixes of 0.1 m/s an axis.
struct InFlightAlignmentOptions {
  double velocity_rate_hz = 10.0;
  double velocity_sigma = 0.1;  ///< an axis [m/s]
};

inline constexpr char kInFlightAlignmentName[] = "in_flight_alignment";

/// End of the straight flight, where the first turn begins [s].
inline constexpr double kFirstManoeuvre = 10.0;

/// The scenario "in_flight_alignment", stream "velocity". Of the start only the
/// position is given, to 10 m: attitude and velocity are for alignment to find.
/// Throws InputError for a rate or sigma that is not positive, for a rate whose
/// measurements fall between IMU samples, and for one that gives a single
/// measurement.
Scenario InFlightAlignment(const InFlightAlignmentOptions& options);

/// A bad start: size of the initial attitude error, drawn in direction alone.
struct BadStart {
  double tilt = 0.0;     ///< about a level axis of any direction [rad]
  double heading = 0.0;  ///< to either side [rad]
};

/// Gives a simulated data set the initial attitude
///   C_nb^ = Exp(-(tilt axis) tilt) Exp(-(+-heading) down) C_nb
/// of its first truth point, with attitude sigmas (tilt, tilt, heading), and
/// the first measured velocity with its sigma.
void GiveBadStart(const BadStart& start, std::uint64_t seed, Dataset* dataset);

/// Turns the IMU in the aircraft of a simulated data set, at an attitude drawn
/// evenly from all rotations: its axes, the truth and the biases with them.
void MountAnywhere(std::uint64_t seed, Dataset* dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_SIMULATION_IN_FLIGHT_ALIGNMENT_H_
