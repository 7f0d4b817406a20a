#ifndef HINDSIGHT_IO_CONFIG_SCENARIO_KEYS_H_
#define HINDSIGHT_IO_CONFIG_SCENARIO_KEYS_H_

#include <vector>

#include "io/config/config_key.h"
#include "simulation/scenario.h"

namespace hindsight {

/// profile, or start and one of segments, wander and way_points.
void ReadMotion(ConfigMap* top, Scenario* scenario);

/// Documentation of the keys that ReadMotion reads.
std::vector<KeySection> MotionSections();

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_SCENARIO_KEYS_H_
