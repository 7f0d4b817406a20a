#ifndef HINDSIGHT_SIMULATION_GPS_JUMPS_H_
#define HINDSIGHT_SIMULATION_GPS_JUMPS_H_

#include <string>
#include <vector>

#include "simulation/scenario.h"

namespace hindsight {

/// An aircraft whose satellite positions jump, after Baek (2019): 250 s at 36 N
/// in level flight of 150 m/s, heading 30 deg, with a banked turn of 3 deg/s
/// from 60 to 90 s. IMU at 100 Hz: gyro 0.005 deg/h and 0.005 deg/sqrt(h) (the
/// paper prints the first with the unit of the second, which is one of a random
/// walk), accelerometer 100 ug, 100 ppm and 10 ug/sqrt(Hz). Start: 5 m, 0.1
/// m/s, tilt 0.006 deg, heading 0.05 deg. Streams "gnss", positions with white
/// errors of `gps_sigma` an axis and the errors of `profile`, and "height" of
/// 0.5 m at the same times.
struct GpsJumpsOptions {
  std::string profile = "pulses";
  double gps_sigma = 1.0;  ///< an axis [m]
  /// Of both streams; the truth has 10 Hz, or the IMU's rate where those do not
  /// fall on the positions, which needs a whole number of samples between them.
  double gps_rate_hz = 1.0;
};

inline constexpr char kGpsJumpsName[] = "gps_jumps";
inline constexpr double kGpsJumpsImuRate = 100.0;  ///< [Hz]

/// An error profile: what is added to the positions, north and east alike.
struct GpsErrorProfile {
  std::string name;
  std::vector<Injection> injections;
};

/// none       nothing
/// pulses     3.5 m over 120-125 s, 12.5 m over 140-150 s
/// spikes     12.5 m of either sign on a tenth of the fixes of 100-200 s
/// steps      3.5 m from 120 s, 12.5 m from 140 s to the end
/// ramp       up to 15 m over 120-220 s, as of a spoofer, then back
/// multipath  Gauss-Markov of 5 m and tau 20 s over 120-180 s
const std::vector<GpsErrorProfile>& GpsErrorProfiles();

/// The scenario "gps_jumps". Throws InputError for an unknown profile and for a
/// sigma or rate that is not positive, or a rate that gives a single position.
Scenario GpsJumps(const GpsJumpsOptions& options);

}  // namespace hindsight

#endif  // HINDSIGHT_SIMULATION_GPS_JUMPS_H_
