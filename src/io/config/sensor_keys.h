#ifndef HINDSIGHT_IO_CONFIG_SENSOR_KEYS_H_
#define HINDSIGHT_IO_CONFIG_SENSOR_KEYS_H_

#include "io/config/config_map.h"
#include "measurements/sensor_kind.h"

namespace hindsight {

/// Reads the keys that the kind of `settings->sensor` declares, but for those
/// of `estimate`, in their order. `simulated`: those of scenarios as well,
/// where no mounting is unknown. Throws InputError that names file, line and
/// key.
void ReadSensorKeys(bool simulated, ConfigMap* map, SensorSettings* settings);

/// Those of the map `estimate`.
void ReadEstimateKeys(ConfigMap* estimate, SensorSettings* settings);

/// What follows from all keys (SensorKind::complete).
void CompleteSettings(ConfigMap* map, SensorSettings* settings);

/// The kind that `type` names; `simulated`: of those that can be simulated.
const SensorKind& ReadKind(bool simulated, ConfigMap* map);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_SENSOR_KEYS_H_
