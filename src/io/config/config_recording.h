#ifndef HINDSIGHT_IO_CONFIG_CONFIG_RECORDING_H_
#define HINDSIGHT_IO_CONFIG_CONFIG_RECORDING_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/config/config.h"
#include "io/config/config_streams.h"

namespace hindsight {

/// Everything the YAML file says, before any data file is read.
struct DeclaredRecording {
  StreamSource imu;
  ImuReadOptions imu_options;
  std::vector<AidingConfig> aiding;
  /// Files of streams that are not read.
  std::vector<std::filesystem::path> left_out;
  std::optional<StreamSource> truth;
  TruthReadOptions truth_options;
  bool truth_clock_unknown = false;
  bool start_from_truth = false;
  ConstantsConfig constants;
  std::vector<Omission> omit;
  std::vector<std::string> unconfirmed;
};

/// Reads the whole configuration; what concerns no file goes into `dataset`.
/// Throws InputError that names file, line and key.
DeclaredRecording ReadDeclarations(ConfigMap* top, const LoadOptions& options,
                                   Dataset* dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_CONFIG_RECORDING_H_
