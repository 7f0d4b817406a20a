#ifndef HINDSIGHT_IO_CONFIG_NOISE_KEYS_H_
#define HINDSIGHT_IO_CONFIG_NOISE_KEYS_H_

#include <string>

#include "io/config/config_help.h"
#include "io/config/config_map.h"
#include "measurements/sensor_kind.h"

namespace hindsight {

/// A plain number greater than zero under `key`.
double ReadFactor(ConfigMap* map, const std::string& key,
                  const std::string& fallback);

/// Whether `noise` states a model whose errors are correlated in time.
bool HasCorrelatedNoise(ConfigMap* map);

/// `noise` of an aiding stream, into Sensor::noise and, of a mixture,
/// Sensor::loss, which must have been read. Throws InputError that names file,
/// line and key.
void ReadNoise(ConfigMap* map, SensorSettings* settings);

/// The keys of all models (measurements/noise_kind.h).
KeySection NoiseSection();

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_NOISE_KEYS_H_
