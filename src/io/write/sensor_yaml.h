#ifndef HINDSIGHT_IO_WRITE_SENSOR_YAML_H_
#define HINDSIGHT_IO_WRITE_SENSOR_YAML_H_

#include "dataset/dataset.h"
#include "io/write/yaml_map.h"

namespace hindsight {

/// A stream as a configuration says it, its file NAME.csv. What stands at its
/// default is left out.
YamlMap SensorMap(const AidingStream& stream);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_SENSOR_YAML_H_
