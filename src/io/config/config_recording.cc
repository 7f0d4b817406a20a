#include "io/config/config_recording.h"

#include <cstdint>
#include <utility>

#include "base/error.h"
#include "io/config/config_files.h"
#include "io/config/config_key.h"
#include "io/config/vehicle.h"
#include "io/read/date_text.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;

std::optional<std::int64_t> ReadEpoch(ConfigMap* top) {
  const auto text = top->OptionalText("epoch");
  if (!text) return std::nullopt;
  const auto stamp = ParseDateTime(*text);
  if (!stamp) {
    top->Fail("epoch", "'" + *text +
                           "' is not a date; expected yyyy-mm-dd hh:mm:ss "
                           "GPST or UTC");
  }
  return Nanoseconds(*stamp);
}

/// What the top level is read by and into.
struct RecordingConfig : DeclaredRecording {
  const LoadOptions* options = nullptr;
  Dataset* dataset = nullptr;
  fs::path folder;
  std::optional<ConfigMap> aiding_map;  ///< for messages
};

/// Of accelerometers with a file of their own, which is on the gyros' clock.
std::optional<StreamSource> ReadAccelerometer(ConfigMap* imu,
                                              const StreamSource& gyros,
                                              const fs::path& folder) {
  if (!imu->Has("accelerometer")) return std::nullopt;
  ConfigMap map = imu->Map("accelerometer");
  if (map.Has("time") || gyros.clock.rate) {
    imu->Fail(
        "accelerometer",
        "is read on the clock of the gyros, by stamps; expected no `time` "
        "of its own, and no rate under `time` of imu");
  }
  StreamSource source = ReadStreamSource(&map, folder, ImuFields());
  map.resolved().remove("time");
  source.clock.scale = gyros.clock.scale;
  source.clock.week = gyros.clock.week;
  source.clock.week_rollovers = gyros.clock.week_rollovers;
  map.Finish();
  return source;
}

void ReadImuConfig(ConfigMap* top, RecordingConfig* recording) {
  if (!top->Has("imu")) top->Fail("imu", "is missing");
  ConfigMap map = top->Map("imu");
  recording->imu = ReadStreamSource(&map, recording->folder, ImuFields());
  const ImuConfig imu = ReadImuKeys(&map);
  recording->imu_options = imu;
  recording->imu_options.accelerometer =
      ReadAccelerometer(&map, recording->imu, recording->folder);
  recording->imu.clock.offset = imu.time_offset;
  recording->dataset->mounting_sigma =
      imu.mounting_sigma.value_or(Eigen::Vector3d::Zero());
  recording->dataset->imu.noise = imu.noise;
  recording->dataset->gyro_scale_sigma = imu.gyro_scale_sigma;
  recording->dataset->accel_scale_sigma = imu.accel_scale_sigma;
  map.Finish();
}

void ReadTruthConfig(ConfigMap* top, RecordingConfig* recording) {
  if (!top->Has("truth")) return;
  ConfigMap map = top->Map("truth");
  recording->truth = ReadStreamSource(&map, recording->folder, TruthFields());
  const TruthConfig truth = ReadTruthKeys(&map);
  recording->truth_options = truth;
  recording->truth_clock_unknown = truth.clock_unknown;
  recording->truth->clock.offset = truth.time_offset;
  recording->dataset->truth_lever_arm_b = truth.lever_arm_b;
  recording->dataset->truth_sigma = truth.sigma;
  map.Finish();
}

/// Names of the streams that rest makes.
void RefuseNamesOfRest(const DeclaredRecording& declared,
                       const ConfigMap& aiding) {
  for (const AidingConfig& stream : declared.aiding) {
    const std::string& name = stream.settings.sensor.name;
    if (name != "zero_velocity" && name != "zero_angular_rate") continue;
    aiding.Fail(name,
                "the name is that of measurements which `stationary` makes; "
                "expected another");
  }
}

void ReadAidingStreams(ConfigMap* top, RecordingConfig* recording) {
  ConfigMap aiding = top->Map("aiding");
  std::vector<std::string> without = recording->options->without;
  for (auto& [name, map] : aiding.NamedMaps()) {
    if (std::erase(without, name) > 0) {
      if (map.Has("file")) {
        for (const std::string& file : FileNames(&map)) {
          recording->left_out.push_back(recording->folder / file);
        }
      }
      aiding.resolved().remove(name);
      continue;
    }
    recording->aiding.push_back(
        ReadAidingConfig(name, &map, recording->folder));
  }
  recording->aiding_map = std::move(aiding);
  if (without.empty()) return;
  throw InputError(top->file() + " has no aiding stream '" + without.front() +
                   "' to be left out");
}

void ReadRest(ConfigMap* top, RecordingConfig* recording) {
  recording->dataset->stationary = ReadStationary(top);
  if (!recording->dataset->stationary.enabled) return;
  RefuseNamesOfRest(*recording, *recording->aiding_map);
}

const std::string& AlignmentHelp() {
  static const std::string kHelp =
      MeaningOf(AlignmentNames(), "how the attitude at the start is found");
  return kHelp;
}

const std::string& VehicleKeyHelp() {
  static const std::string kHelp =
      MeaningOf(VehicleNames(),
                "sets what suits it and is not given: rest, wheels, spread of "
                "the start (hindsight help vehicles)");
  return kHelp;
}

const ConfigTable<RecordingConfig>& RecordingTable() {
  using Key = ConfigKey<RecordingConfig>;
  using Recording = RecordingConfig;
  static const ConfigTable<Recording> kTable = {
      "",
      "One YAML file. Every physical value carries its unit. A key that is not "
      "listed is an error.",
      {{.name = "name",
        .value = Key::Special{[](ConfigMap* top, Recording* recording) {
          recording->dataset->name =
              top->Text("name", fs::path(top->file()).stem().string());
        }},
        .help = "of the recording",
        .fallback = "file name"},
       {.name = "folder",
        .value = Key::Special{[](ConfigMap* top, Recording* recording) {
          recording->folder = FindFolder(top, *recording->options);
        }},
        .help = "of the files: relative to the configuration, or to the data "
                "root",
        .fallback = "."},
       {.name = "epoch",
        .value = Key::Special{[](ConfigMap* top, Recording* recording) {
          recording->dataset->epoch_gps_ns = ReadEpoch(top);
        }},
        .help = "date and time at t = 0, \"yyyy-mm-dd hh:mm:ss GPST\" or "
                "\"UTC\"",
        .fallback =
            "whole second before the first IMU sample, if that is dated"},
       {.name = "vehicle",
        .value = Key::Special{[](ConfigMap* top, Recording*) {
          if (top->Has("vehicle")) {
            top->Choice("vehicle", VehicleNames(), std::nullopt);
          }
        }},
        .help = VehicleKeyHelp()},
       {.name = "imu",
        .value = Key::Special{ReadImuConfig},
        .help = "the inertial sensor",
        .needed = true},
       {.name = "aiding",
        .value = Key::Special{ReadAidingStreams},
        .help = "NAME: a stream each; NAME of letters, digits, _ - ."},
       {.name = "constants",
        .value = Key::Special{[](ConfigMap* top, Recording* recording) {
          recording->constants =
              ReadConstantsConfig(top, recording->options->constants);
        }},
        .help = "what is taken from an earlier result"},
       {.name = "place",
        .value = Key::Special{[](ConfigMap* top, Recording* recording) {
          recording->dataset->place = ReadGeodetic(top, "place");
        }},
        .help =
            "[lat, lon, h] where attitude alone is estimated and no position "
            "is given or measured: gives gravity and the Earth's rate, which "
            "are 9.80665 m/s^2 and nothing without"},
       {.name = "ahrs",
        .value = Key::Special{[](ConfigMap* top, Recording* recording) {
          recording->dataset->ahrs = ReadAhrs(top);
        }},
        .help = "settings of the methods for attitude alone"},
       {.name = "initial",
        .value = Key::Special{[](ConfigMap* top, Recording* recording) {
          recording->dataset->initial =
              ReadInitialState(top, &recording->start_from_truth);
        }},
        .help = "what is known of the start"},
       {.name = "alignment",
        .value = Key::Special{},
        .help = AlignmentHelp(),
        .fallback = "auto"},
       {.name = "stationary",
        .value = Key::Special{ReadRest},
        .help = "off, on, or its thresholds",
        .fallback = "off"},
       {.name = "truth",
        .value = Key::Special{ReadTruthConfig},
        .help = "a reference trajectory, which estimators never see"},
       {.name = "withhold",
        .value = Key::Special{[](ConfigMap* top, Recording* recording) {
          recording->dataset->withholdings = ReadWithholdings(top);
        }},
        .help = "list of {sensor, every, length, from}"},
       {.name = "omit",
        .value = Key::Special{[](ConfigMap* top, Recording* recording) {
          recording->omit = ReadOmissions(top);
        }},
        .help =
            "list of {sensor, from, to}: spans of its measurements that are "
            "neither used nor judged"},
       {.name = "unconfirmed",
        .value = Key::Special{[](ConfigMap* top, Recording* recording) {
          recording->unconfirmed = top->List("unconfirmed");
        }},
        .help = "list of what a drafted configuration takes for granted: while "
                "there is any, a result is at best doubtful"},
       {.name = "nodes",
        .value = Key::Special{[](ConfigMap* top, Recording* recording) {
          ReadNodes(top, &recording->dataset->max_node_spacing);
        }},
        .help = "max_spacing: longest interval between states",
        .fallback = "{max_spacing: 1 s}"}}};
  return kTable;
}

/// Of all streams' files.
void GatherDigests(ReadDigests* digests, DeclaredRecording* declared) {
  declared->imu.digests = digests;
  if (auto& accelerometer = declared->imu_options.accelerometer) {
    accelerometer->digests = digests;
  }
  if (declared->truth) declared->truth->digests = digests;
  for (AidingConfig& config : declared->aiding) config.source.digests = digests;
}

}  // namespace

DeclaredRecording ReadDeclarations(ConfigMap* top, const LoadOptions& options,
                                   Dataset* dataset) {
  RecordingConfig recording;
  recording.options = &options;
  recording.dataset = dataset;
  ReadTable(RecordingTable(), top, &recording);
  top->Finish();
  RequireFiles(recording);
  GatherDigests(options.digests, &recording);
  return recording;
}

KeySection RecordingSection() { return Documented(RecordingTable()); }

}  // namespace hindsight
