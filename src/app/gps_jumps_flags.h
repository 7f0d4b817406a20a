#ifndef HINDSIGHT_APP_GPS_JUMPS_FLAGS_H_
#define HINDSIGHT_APP_GPS_JUMPS_FLAGS_H_

#include <vector>

#include "simulation/gps_jumps.h"

namespace hindsight {

/// The settings that --errors, --gps-sigma and --gps-rate ask for, every
/// profile at every sigma and rate. Without --errors: all profiles, pulses
/// first. Throws UsageError.
std::vector<GpsJumpsOptions> ReadGpsJumpsFlags();

}  // namespace hindsight

#endif  // HINDSIGHT_APP_GPS_JUMPS_FLAGS_H_
