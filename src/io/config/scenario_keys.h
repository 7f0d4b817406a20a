#ifndef HINDSIGHT_IO_CONFIG_SCENARIO_KEYS_H_
#define HINDSIGHT_IO_CONFIG_SCENARIO_KEYS_H_

#include <string>
#include <vector>

#include "io/config/config_key.h"
#include "simulation/scenario.h"

namespace hindsight {

/// profile, or start and one of segments, wander and way_points.
void ReadMotion(ConfigMap* top, Scenario* scenario);

/// imu, with its errors.
void ReadImuModel(ConfigMap* top, Scenario* scenario);

/// A sensor of aiding.
AidingModel ReadAidingModel(const std::string& name, ConfigMap* map);

/// Documentation of the keys that ReadMotion reads, and those of the imu and of
/// the sensors of aiding.
std::vector<KeySection> MotionSections();
std::vector<KeySection> SimulatedSensorSections();

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_SCENARIO_KEYS_H_
