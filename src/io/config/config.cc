#include "io/config/config.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "dataset/timeline_builder.h"
#include "dataset/truth_start.h"
#include "io/config/config_omissions.h"
#include "io/config/config_recording.h"
#include "io/config/constants_reader.h"
#include "io/config/load_streams.h"
#include "io/config/vehicle.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;

/// Values of a time at which nobody was there are values of another.
void RequireStartInside(ConfigMap* top, const Dataset& dataset) {
  const ImuStream& imu = dataset.imu;
  if (!dataset.initial.t) return;
  const double t = *dataset.initial.t;
  const double slack = 2.0 * imu.nominal_dt;
  if (t >= imu.t_begin() - slack && t < imu.t_end()) return;
  top->Map("initial").Fail(
      "time", fmt::format("lies outside the IMU's record, {:.3f} to {:.3f} s",
                          imu.t_begin(), imu.t_end()));
}

void RequireNodes(ConfigMap* top, const Dataset& dataset) {
  // Attitude alone has no nodes, and may be of a slower IMU.
  if (!top->Has("nodes")) return;
  if (const auto why = WhyNotNodes(dataset)) {
    top->Map("nodes").Fail("max_spacing", *why);
  }
}

/// So that the resolved configuration loads the same whatever the data say.
void ResolveTruthOffset(const DeclaredRecording& declared, double offset,
                        ConfigMap* top) {
  const std::string text = FormatNumber(offset) + " s";
  if (declared.truth_clock_unknown) {
    top->resolved()["truth"]["time_offset"] = text;
  }
  for (const AidingConfig& config : declared.aiding) {
    if (!config.clock_of_truth) continue;
    if (!declared.truth) {
      throw InputError(config.source.config_path, config.source.config_line,
                       config.source.name + ".time_offset: there is no truth");
    }
    top->resolved()["aiding"][config.settings.sensor.name]["time_offset"] =
        text;
  }
}

/// What the earlier result says, less what is not to be taken.
void TakeConstants(const ConstantsConfig& config,
                   const std::vector<std::string>& without, ConfigMap* top,
                   Dataset* dataset) {
  if (config.from.empty()) return;
  RecordedConstants recorded = ReadConstants(config.from, config.method);
  for (const std::string& name : config.without) {
    if (recorded.Remove(name)) continue;
    top->Map("constants")
        .Fail("without",
              config.from.string() + " has no constant '" + name + "'");
  }
  if (recorded.grade != Grade::kUsable) {
    dataset->notes.push_back("constants are from " + recorded.source +
                             ", which is " + GradeName(recorded.grade));
  }
  UseConstants(KnownFrom(recorded), without, dataset);
  top->resolved()["constants"]["from"] =
      fs::absolute(config.from).lexically_normal().string();
}

void TakeStart(ConfigMap* top, Dataset* dataset) {
  try {
    StartFromTruth(dataset);
  } catch (const InputError& error) {
    top->Map("initial").Fail("from", error.what());
  }
}

/// With what its vehicle sets, of which `note` tells.
ConfigMap LoadTop(const std::string& path, const LoadOptions& options,
                  std::string* note) {
  const ConfigMap::Edit edit = SetVehicle(note);
  return options.text ? ConfigMap::Parse(*options.text, path, edit)
                      : ConfigMap::Load(path, edit);
}

std::vector<fs::path> FilesRead(const std::string& config_path,
                                const DeclaredRecording& declared) {
  std::vector<fs::path> inputs = {config_path};
  const auto add = [&](const StreamSource& source) {
    for (const std::string& path : source.Paths()) inputs.emplace_back(path);
  };
  add(declared.imu);
  if (declared.imu_options.accelerometer) {
    add(*declared.imu_options.accelerometer);
  }
  for (const AidingConfig& config : declared.aiding) {
    if (!config.settings.sensor.kind->generated) add(config.source);
  }
  if (declared.truth) add(*declared.truth);
  if (!declared.constants.from.empty()) {
    inputs.push_back(SummaryOf(declared.constants.from));
  }
  return inputs;
}

}  // namespace

std::vector<fs::path> ConfigFilesRead(const std::string& config_path,
                                      const LoadOptions& options) {
  std::string note;
  ConfigMap top = LoadTop(config_path, options, &note);
  Dataset dataset;
  return FilesRead(config_path, ReadDeclarations(&top, options, &dataset));
}

std::vector<fs::path> ConfigInputs(const std::string& config_path,
                                   const LoadOptions& options) {
  std::string note;
  ConfigMap top = LoadTop(config_path, options, &note);
  Dataset dataset;
  const DeclaredRecording declared = ReadDeclarations(&top, options, &dataset);
  std::vector<fs::path> inputs = FilesRead(config_path, declared);
  inputs.insert(inputs.end(), declared.left_out.begin(),
                declared.left_out.end());
  return inputs;
}

Dataset LoadDataset(const std::string& config_path, const LoadOptions& options,
                    ResolvedConfig* resolved) {
  std::string note;
  ConfigMap top = LoadTop(config_path, options, &note);
  Dataset dataset;
  if (!note.empty()) dataset.notes.push_back(note);
  const DeclaredRecording declared = ReadDeclarations(&top, options, &dataset);
  StreamsBeside beside(declared);
  LoadImu(declared, &top, &dataset);
  RequireStartInside(&top, dataset);
  RequireNodes(&top, dataset);
  const double truth_offset = LoadTruth(declared, &beside, &dataset);
  ResolveTruthOffset(declared, truth_offset, &top);
  LoadAidingStreams(declared, truth_offset, &beside, &dataset);
  TakeConstants(declared.constants, options.without, &top, &dataset);
  ApplyOmissions(declared.omit, options, &top, &dataset);
  if (declared.start_from_truth) TakeStart(&top, &dataset);
  try {
    ApplyWithholding(&dataset);
  } catch (const InputError& error) {
    top.Fail("withhold", error.what());
  }
  if (resolved != nullptr) {
    resolved->yaml = EmitYaml(top.resolved());
    resolved->unconfirmed = declared.unconfirmed;
  }
  return dataset;
}

}  // namespace hindsight
