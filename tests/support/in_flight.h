#ifndef HINDSIGHT_TESTS_SUPPORT_IN_FLIGHT_H_
#define HINDSIGHT_TESTS_SUPPORT_IN_FLIGHT_H_

#include "base/text.h"
#include "io/config/scenario_config.h"
#include "simulation/bad_start.h"

namespace hindsight {

/// End of the straight flight, where the first turn begins [s].
inline constexpr double kFirstManoeuvre = 10.0;

/// data/scenarios/in_flight_alignment.yaml with velocities at a rate.
inline Scenario InFlightAlignment(double rate_hz = 10.0) {
  return FindScenario(
      "in_flight_alignment",
      {"aiding.velocity.rate=" + FormatNumber(rate_hz) + " Hz"});
}

}  // namespace hindsight

#endif  // HINDSIGHT_TESTS_SUPPORT_IN_FLIGHT_H_
