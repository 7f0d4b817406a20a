#ifndef HINDSIGHT_IO_CONFIG_STREAMS_H_
#define HINDSIGHT_IO_CONFIG_STREAMS_H_

#include <Eigen/Core>
#include <filesystem>

#include "io/config_map.h"
#include "io/reader.h"

namespace hindsight {

/// The keys that every stream has; keys are listed in io/config.h.
/// `fields` are the quantities that `columns` may name.
StreamSource ReadStreamSource(ConfigMap* map,
                              const std::filesystem::path& folder,
                              const std::vector<FieldName>& fields);

/// C_bs of `axes` and `mounting`.
Eigen::Matrix3d ReadMounting(ConfigMap* imu);

/// `noise` of the imu.
ImuNoise ReadImuNoise(ConfigMap* imu);

/// One aiding stream's sensor and how its file is read.
struct AidingConfig {
  Sensor sensor;
  StreamSource source;
  AidingReadOptions options;
};
AidingConfig ReadAidingConfig(const std::string& name, ConfigMap* map,
                              const std::filesystem::path& folder);

InitialState ReadInitialState(ConfigMap* top);
StationaryOptions ReadStationary(ConfigMap* top);
std::vector<Withholding> ReadWithholdings(ConfigMap* top);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_STREAMS_H_
