#ifndef HINDSIGHT_IO_CONFIG_CONFIG_H_
#define HINDSIGHT_IO_CONFIG_CONFIG_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dataset/dataset.h"
#include "io/read/file_digest.h"

namespace hindsight {

/// \file
/// The configuration of a recording: one YAML file. Every physical value
/// carries its unit (io/read/units.h). ConfigSections (config_help.h) lists the
/// keys; one that is not in it is an error. What is asked for is bounded: 31
/// days of the IMU's record, 100000 outages of a sensor, columns up to the
/// 100000th, ten measurements without a file for each sample of the IMU, 1000000
/// ahrs.samples or 3600 s, 10 million nodes, 4 MB of configuration.

/// A span of a sensor's measurements that are neither used nor judged.
struct Omission {
  std::string sensor;  ///< stream name, or a type: "position", "velocity"...
  double from = 0.0;   ///< [s]
  double to = 0.0;     ///< exclusive [s]
};

/// "SENSOR:T1..T2" with times in seconds since the data set's epoch, as "gnss:100
/// s..130 s"; seconds where there is no unit. Throws std::invalid_argument.
Omission ParseOmission(const std::string& text);

struct LoadOptions {
  /// Where folders are looked for that are not beside the configuration;
  /// nowhere else if empty.
  std::string data_root = {};
  /// Aiding streams of the configuration that are left out, by name.
  std::vector<std::string> without = {};
  /// Result whose constants are used, in place of constants.from; none if
  /// empty.
  std::string constants = {};
  /// Spans that are left out besides those of the configuration.
  std::vector<Omission> omit = {};
  /// The configuration itself, in place of the content of its file.
  std::optional<std::string> text = {};
  /// What digests of streams' files go to where reading makes them; may be null.
  ReadDigests* digests = nullptr;
};

/// Everything a load used, in SI units, defaults included; itself a
/// configuration that loads the same data set.
struct ResolvedConfig {
  std::string yaml;
  /// What the configuration takes for granted and nobody has confirmed.
  std::vector<std::string> unconfirmed = {};
};

/// The files and folders that loading the configuration reads, itself and those
/// of streams that are left out included. Throws InputError as LoadDataset does
/// for what the configuration says.
std::vector<std::filesystem::path> ConfigInputs(
    const std::string& config_path, const LoadOptions& options = {});

/// Those of them that are read: without the files of streams left out.
std::vector<std::filesystem::path> ConfigFilesRead(
    const std::string& config_path, const LoadOptions& options = {});

/// Reads a configuration and all files it names. Throws InputError, one line
/// naming file and line. `resolved` may be null.
Dataset LoadDataset(const std::string& config_path,
                    const LoadOptions& options = {},
                    ResolvedConfig* resolved = nullptr);

/// Replaces the list `withhold` by what was actually withheld.
void SetWithholdings(const std::vector<Withholding>& withholdings,
                     ResolvedConfig* resolved);

/// Writes the resolved configuration to `path`, complete or not at all.
void WriteResolvedConfig(const ResolvedConfig& resolved,
                         const std::string& path);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_CONFIG_H_
