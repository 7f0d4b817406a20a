#ifndef HINDSIGHT_SIMULATION_VIBRATION_ATTITUDE_H_
#define HINDSIGHT_SIMULATION_VIBRATION_ATTITUDE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "dataset/dataset.h"

namespace hindsight {

/// Name of the scenario in `hindsight montecarlo`.
inline constexpr char kVibrationAttitudeName[] = "vibration_attitude";

/// The scenario of Kim and Leeghim (2016), tables 2 and 3: a body that turns
/// gently for 60 s at 10 Hz, accelerates from 5 s to 10 s and vibrates from 40 s
/// to 45 s; samples with white errors of 0.1 deg/s, 0.03 g and 0.3 uT, gyro bias
/// of 10 deg/h. What the paper leaves open is chosen here: a free body (Euler's
/// equations, about 50 deg/s throughout), a vibration of all three axes, field
/// of 30 uT horizontal and 40 uT down, attitude error at the start of 2 deg an
/// axis.
struct VibrationAttitudeOptions {
  /// Where the acceleration points: "north", "body_x", "body_xyz" (all three
  /// body axes, each with the full size) or "up".
  std::string axis = "north";
  /// The vibration points there too.
  bool vibration_along_axis = false;
  double acceleration = 3.0;     ///< 5 s to 10 s [m/s^2]
  double vibration_sigma = 3.0;  ///< 40 s to 45 s [m/s^2]
};

/// "north", "body_x", "body_xyz", "up".
const std::vector<std::string>& VibrationAxes();

/// One realisation: rates (Dataset::imu), field (the first stream, vector
/// form), truth with attitude and gyro bias at every sample, and the erroneous
/// start (initial.euler and sigmas). No place: gravity is the standard one and
/// the Earth does not turn.
Dataset SimulateVibrationAttitude(const VibrationAttitudeOptions& options,
                                  std::uint64_t seed);

}  // namespace hindsight

#endif  // HINDSIGHT_SIMULATION_VIBRATION_ATTITUDE_H_
