#include "io/config/config.h"

#include <fmt/core.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "base/error.h"
#include "dataset/clock_search.h"
#include "dataset/truth_start.h"
#include "io/config/config_key.h"
#include "io/config/config_streams.h"
#include "io/config/constants_reader.h"
#include "io/read/paths.h"
#include "io/write/atomic_file.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;

fs::path FindFolder(ConfigMap* top, const LoadOptions& options) {
  const fs::path folder = top->Text("folder", ".");
  const fs::path beside = fs::path(top->file()).parent_path() / folder;
  std::vector<fs::path> candidates = {beside};
  if (!options.data_root.empty()) {
    candidates.push_back(fs::path(options.data_root) / folder);
  }
  std::string looked_for;
  for (const fs::path& candidate : candidates) {
    if (IsFolder(candidate)) {
      top->Resolve("folder",
                   fs::absolute(candidate).lexically_normal().string());
      return candidate;
    }
    looked_for += (looked_for.empty() ? "there is no folder " : " and no ") +
                  candidate.lexically_normal().string();
  }
  top->Fail("folder",
            looked_for + (options.data_root.empty()
                              ? "; --data-root=DIR looks for it in DIR too"
                              : " (the data root is set by --data-root)"));
}

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

/// Everything the YAML file says, before any data file is read.
struct Declared {
  StreamSource imu;
  ImuReadOptions imu_options;
  std::vector<AidingConfig> aiding;
  std::vector<fs::path> left_out;  ///< files of streams that are not read
  std::optional<StreamSource> truth;
  TruthReadOptions truth_options;
  bool truth_clock_unknown = false;
  bool start_from_truth = false;
  ConstantsConfig constants;
  std::vector<Omission> omit;
  std::vector<std::string> unconfirmed;
};

/// What the top level is read by and into.
struct RecordingConfig : Declared {
  const LoadOptions* options = nullptr;
  Dataset* dataset = nullptr;
  fs::path folder;
  std::optional<ConfigMap> aiding_map;  ///< for messages
};

void ReadImuConfig(ConfigMap* top, RecordingConfig* recording) {
  if (!top->Has("imu")) top->Fail("imu", "is missing");
  ConfigMap map = top->Map("imu");
  recording->imu = ReadStreamSource(&map, recording->folder, ImuFields());
  const ImuConfig imu = ReadImuKeys(&map);
  recording->imu_options = imu;
  recording->imu.clock.offset = imu.time_offset;
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
void RefuseNamesOfRest(const Declared& declared, const ConfigMap& aiding) {
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
      if (const auto file = map.OptionalText("file")) {
        recording->left_out.push_back(recording->folder / *file);
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
            "[lat, lon, h] where attitude alone is estimated: gives gravity "
            "and the Earth's rate, which are 9.80665 m/s^2 and nothing "
            "without it"},
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

Declared ReadDeclarations(ConfigMap* top, const LoadOptions& options,
                          Dataset* dataset) {
  RecordingConfig recording;
  recording.options = &options;
  recording.dataset = dataset;
  ReadTable(RecordingTable(), top, &recording);
  top->Finish();
  return recording;
}

std::string Span(double begin, double end) {
  return fmt::format("{:.3f} to {:.3f} s", begin, end);
}

void RequireOverlap(const StreamSource& source, const ImuStream& imu,
                    double begin, double end) {
  if (begin <= imu.t_end() && end >= imu.t_begin()) return;
  const double ratio = (end - begin) / (imu.t_end() - imu.t_begin());
  constexpr double kOffByUnits = 20.0;
  const bool unit = ratio > kOffByUnits || ratio < 1.0 / kOffByUnits;
  throw InputError(
      source.config_path, source.config_line,
      source.name + " (" + source.path + ") covers " + Span(begin, end) +
          " and the IMU " + Span(imu.t_begin(), imu.t_end()) +
          ": expected streams that overlap; " +
          (unit ? fmt::format("its span is {:.3g} times the IMU's: "
                              "is the unit of its t, or the rate, "
                              "that of the file?",
                              ratio)
                : "where the clocks have nothing in common, give "
                  "both `time: {start: 0 s}` and it `time_offset: "
                  "unknown`"));
}

/// What is made for every second of the record is bounded by this.
void RequireModestSpan(const StreamSource& source, const ImuStream& imu) {
  constexpr double kMostDays = 31.0;
  if (imu.t_end() - imu.t_begin() <= kMostDays * kDaySeconds) return;
  throw InputError(source.config_path, source.config_line,
                   source.name + " (" + source.path + ") covers " +
                       Span(imu.t_begin(), imu.t_end()) +
                       "; expected at most 31 days");
}

/// How many measurements `step` apart the record takes.
long CountGenerated(const AidingConfig& config, const ImuStream& imu,
                    double step) {
  const double count = (imu.t_end() - imu.t_begin()) / step;
  const double most = 10.0 * static_cast<double>(imu.samples.size());
  if (count <= most) return static_cast<long>(count);
  throw InputError(
      config.source.config_path, config.source.config_line,
      config.source.name + fmt::format(": the rate makes {:.3g} measurements; "
                                       "expected at most {:.0f}, ten "
                                       "for each sample of the IMU",
                                       count, most));
}

void LoadImu(const Declared& declared, ConfigMap* top, Dataset* dataset) {
  StreamClock clock;
  const ImuNoise noise = dataset->imu.noise;
  dataset->imu =
      ReadImu(declared.imu, declared.imu_options, &clock, &dataset->policies);
  dataset->imu.noise = noise;
  top->resolved()["imu"]["kind"] =
      dataset->imu.kind == ImuStream::Kind::kRates ? "rates" : "increments";
  if (!dataset->epoch_gps_ns) {
    if (const auto first = FirstGpsTime(declared.imu, clock)) {
      constexpr std::int64_t kSecond = 1'000'000'000;
      dataset->epoch_gps_ns = Nanoseconds(*first) / kSecond * kSecond;
    }
  }
  if (dataset->epoch_gps_ns) {
    top->Resolve("epoch", FormatGpsTime(*dataset->epoch_gps_ns));
  }
  const TimeLine line = MapClock(declared.imu, clock, dataset->epoch_gps_ns);
  for (ImuSample& sample : dataset->imu.samples) sample.t = line(sample.t);
  RequireModestSpan(declared.imu, dataset->imu);
  dataset->imu.stamp_offset = declared.imu.clock.offset;
  dataset->imu.nominal_dt = MedianInterval(dataset->imu);
}

/// Values of a time at which nobody was there are values of another.
void RequireStartInside(ConfigMap* top, const Dataset& dataset) {
  const ImuStream& imu = dataset.imu;
  if (!dataset.initial.t) return;
  const double t = *dataset.initial.t;
  const double slack = 2.0 * imu.nominal_dt;
  if (t >= imu.t_begin() - slack && t < imu.t_end()) return;
  top->Map("initial").Fail("time", "lies outside the IMU's record, " +
                                       Span(imu.t_begin(), imu.t_end()));
}

/// The constraint holds at all times: measurements of nobody's making.
MeasurementSeries Generate(const AidingConfig& config, int sensor,
                           const ImuStream& imu) {
  const double step = 1.0 / config.settings.rate_hz;
  MeasurementSeries measurements;
  const long count = CountGenerated(config, imu, step);
  for (long k = 0; k <= count; ++k) {
    measurements.push_back({imu.t_begin() + static_cast<double>(k) * step,
                            sensor, false, config.settings.pattern});
  }
  return measurements;
}

/// Where the stream's clock stands as far as the motion tells; which of several
/// is for the estimators to say.
void FindClock(const AidingConfig& config, Dataset* dataset,
               AidingStream* stream) {
  stream->clock_unknown = true;
  const ClockSearch found =
      SearchClock(dataset->imu, dataset->initial, *stream);
  if (!TakeClock(found, stream)) {
    throw InputError(config.source.config_path, config.source.config_line,
                     config.source.name +
                         ".time_offset: is not found: no offset brings its "
                         "motion into line with the IMU's; expected readings "
                         "of changing speed or turns, or a value");
  }
  dataset->notes.push_back(config.settings.sensor.name +
                           ": time offset found: " + Describe(found));
}

void LoadAiding(const AidingConfig& config, double truth_offset,
                const ClockMap& imu_clock, Dataset* dataset) {
  AidingStream stream;
  stream.clock_placed = config.source.clock.placed() || imu_clock.placed();
  stream.sensor = config.settings.sensor;
  const int index = static_cast<int>(dataset->streams.size());
  if (config.clock_of_truth) stream.sensor.time_offset = truth_offset;
  if (stream.sensor.kind->generated) {
    stream.measurements = Generate(config, index, dataset->imu);
    dataset->streams.push_back(std::move(stream));
    return;
  }
  StreamClock clock;
  stream.measurements = ReadAiding(config.source, config.settings, index,
                                   &clock, &dataset->policies);
  const TimeLine line = MapClock(config.source, clock, dataset->epoch_gps_ns);
  for (Measurement& z : stream.measurements.Edited()) {
    z.t = line(z.t);
    if (auto* odometer = std::get_if<Odometer>(&z.model)) {
      odometer->t_from = line(odometer->t_from);
    }
  }
  if (config.clock_unknown) FindClock(config, dataset, &stream);
  const double offset = stream.sensor.time_offset;
  RequireOverlap(config.source, dataset->imu,
                 stream.measurements.front().t + offset,
                 stream.measurements.back().t + offset);
  dataset->streams.push_back(std::move(stream));
}

bool Speaks(const Omission& omission, const Sensor& sensor) {
  return omission.sensor == sensor.name ||
         omission.sensor == sensor.kind->name ||
         omission.sensor == sensor.kind->family;
}

/// Takes the measurements of a span out of every stream that it names.
void Omit(const Omission& omission, const std::string& place,
          Dataset* dataset) {
  bool known = false;
  long count = 0;
  for (AidingStream& stream : dataset->streams) {
    if (!Speaks(omission, stream.sensor)) continue;
    known = true;
    MeasurementSeries kept;
    for (const Measurement& z : stream.measurements) {
      const double t = z.t + stream.sensor.time_offset;
      const bool omitted = t >= omission.from && t < omission.to;
      if (!omitted) kept.push_back(z);
      count += omitted ? 1 : 0;
    }
    if (kept.empty()) {
      throw InputError(place + ": leaves no measurement of " +
                       stream.sensor.name + "; --without leaves it out whole");
    }
    stream.measurements = std::move(kept);
  }
  const std::string span =
      omission.sensor + " from " +
      fmt::format("{:g} s to {:g} s", omission.from, omission.to);
  if (!known) {
    throw InputError(place + ": no aiding stream is named or of the type '" +
                     omission.sensor + "'");
  }
  if (count == 0) {
    throw InputError(place + ": " + span +
                     " holds no measurement; expected times since the data "
                     "set's epoch");
  }
  dataset->policies.push_back({omission.sensor, "omitted", count});
}

void ApplyOmissions(const Declared& declared, const LoadOptions& options,
                    ConfigMap* top, Dataset* dataset) {
  for (const Omission& omission : declared.omit) {
    Omit(omission,
         top->file() + ":" + std::to_string(top->Line("omit")) + ": omit",
         dataset);
  }
  for (const Omission& omission : options.omit) {
    Omit(omission, "--omit", dataset);
    YAML::Node entry;
    entry["sensor"] = omission.sensor;
    entry["from"] = FormatNumber(omission.from) + " s";
    entry["to"] = FormatNumber(omission.to) + " s";
    top->resolved()["omit"].push_back(entry);
  }
}

/// The prior "level on average", spread over the record: a second stream.
void AddLevel(const SensorSettings& settings, int vehicle, Dataset* dataset) {
  if (!settings.level_sigma) return;
  constexpr double kPeriod = 1.0;
  const ImuStream& imu = dataset->imu;
  AidingStream stream;
  stream.sensor.name = settings.sensor.name + "_level";
  stream.sensor.kind = &VehicleLevelKind();
  stream.sensor.q_sb = settings.sensor.q_sb;
  stream.sensor.vehicle = vehicle;
  const int count =
      static_cast<int>((imu.t_end() - imu.t_begin()) / kPeriod) + 1;
  const VehicleLevel level{*settings.level_sigma *
                           std::sqrt(static_cast<double>(count))};
  const int index = static_cast<int>(dataset->streams.size());
  for (int k = 0; k < count; ++k) {
    stream.measurements.push_back(
        {imu.t_begin() + k * kPeriod, index, false, level});
  }
  dataset->streams.push_back(std::move(stream));
}

/// Moves the truth to where its attitudes fit the gyros; by how much.
double FitTruthClock(const StreamSource& source, Dataset* dataset) {
  const ClockSearch found = SearchClock(dataset->imu, dataset->truth);
  if (found.candidates.empty()) {
    throw InputError(source.config_path, source.config_line,
                     "truth.time_offset: is not found by the gyros; expected "
                     "a truth with attitudes that turn");
  }
  const double offset = found.candidates.front().offset;
  for (TruthPoint& point : dataset->truth.Edited()) point.t += offset;
  dataset->notes.push_back("truth: time offset found: " + Describe(found));
  return offset;
}

/// The time offset of the truth's stamps.
double LoadTruth(const Declared& declared, Dataset* dataset) {
  if (!declared.truth) return 0.0;
  StreamClock clock;
  dataset->truth = ReadTruth(*declared.truth, declared.truth_options, &clock,
                             &dataset->policies);
  const TimeLine line = MapClock(*declared.truth, clock, dataset->epoch_gps_ns);
  for (TruthPoint& point : dataset->truth.Edited()) point.t = line(point.t);
  const double offset = declared.truth_clock_unknown
                            ? FitTruthClock(*declared.truth, dataset)
                            : declared.truth->clock.offset;
  RequireOverlap(*declared.truth, dataset->imu, dataset->truth.front().t,
                 dataset->truth.back().t);
  return offset;
}

/// So that the resolved configuration loads the same whatever the data say.
void ResolveTruthOffset(const Declared& declared, double offset,
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

std::string Emit(const YAML::Node& node) {
  YAML::Emitter emitter;
  emitter << node;
  return std::string(emitter.c_str()) + "\n";
}

}  // namespace

KeySection RecordingSection() { return Documented(RecordingTable()); }

namespace {

std::vector<fs::path> FilesRead(const std::string& config_path,
                                const Declared& declared) {
  std::vector<fs::path> inputs = {config_path, declared.imu.path};
  for (const AidingConfig& config : declared.aiding) {
    if (!config.settings.sensor.kind->generated)
      inputs.emplace_back(config.source.path);
  }
  if (declared.truth) inputs.emplace_back(declared.truth->path);
  if (!declared.constants.from.empty()) {
    inputs.push_back(SummaryOf(declared.constants.from));
  }
  return inputs;
}

}  // namespace

std::vector<fs::path> ConfigFilesRead(const std::string& config_path,
                                      const LoadOptions& options) {
  ConfigMap top = ConfigMap::Load(config_path);
  Dataset dataset;
  return FilesRead(config_path, ReadDeclarations(&top, options, &dataset));
}

std::vector<fs::path> ConfigInputs(const std::string& config_path,
                                   const LoadOptions& options) {
  ConfigMap top = ConfigMap::Load(config_path);
  Dataset dataset;
  const Declared declared = ReadDeclarations(&top, options, &dataset);
  std::vector<fs::path> inputs = FilesRead(config_path, declared);
  inputs.insert(inputs.end(), declared.left_out.begin(),
                declared.left_out.end());
  return inputs;
}

Dataset LoadDataset(const std::string& config_path, const LoadOptions& options,
                    ResolvedConfig* resolved) {
  ConfigMap top = options.text ? ConfigMap::Parse(*options.text, config_path)
                               : ConfigMap::Load(config_path);
  Dataset dataset;
  const Declared declared = ReadDeclarations(&top, options, &dataset);
  LoadImu(declared, &top, &dataset);
  RequireStartInside(&top, dataset);
  const double truth_offset = LoadTruth(declared, &dataset);
  ResolveTruthOffset(declared, truth_offset, &top);
  for (const AidingConfig& config : declared.aiding) {
    LoadAiding(config, truth_offset, declared.imu.clock, &dataset);
  }
  for (std::size_t i = 0; i < declared.aiding.size(); ++i) {
    AddLevel(declared.aiding[i].settings, static_cast<int>(i), &dataset);
  }
  TakeConstants(declared.constants, options.without, &top, &dataset);
  ApplyOmissions(declared, options, &top, &dataset);
  if (declared.start_from_truth) TakeStart(&top, &dataset);
  try {
    ApplyWithholding(&dataset);
  } catch (const InputError& error) {
    top.Fail("withhold", error.what());
  }
  if (resolved != nullptr) {
    resolved->yaml = Emit(top.resolved());
    resolved->unconfirmed = declared.unconfirmed;
  }
  return dataset;
}

Omission ParseOmission(const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::size_t dots = text.find("..", std::min(colon, text.size()));
  if (colon == 0 || colon == text.npos || dots == text.npos) {
    throw std::invalid_argument(
        "expected SENSOR:T1..T2, as gnss:100..130, in seconds since the data "
        "set's epoch");
  }
  const auto seconds = [](const std::string& word) {
    const auto number = ParseNumber(Trim(word));
    return number ? *number : ParseQuantity(word, Quantity::kTime);
  };
  Omission omission{text.substr(0, colon),
                    seconds(text.substr(colon + 1, dots - colon - 1)),
                    seconds(text.substr(dots + 2))};
  if (!(omission.to > omission.from)) {
    throw std::invalid_argument("T2 must lie behind T1");
  }
  return omission;
}

void SetWithholdings(const std::vector<Withholding>& withholdings,
                     ResolvedConfig* resolved) {
  YAML::Node top = YAML::Load(resolved->yaml);
  YAML::Node list(YAML::NodeType::Sequence);
  for (const Withholding& withholding : withholdings) {
    YAML::Node entry;
    entry["sensor"] = withholding.sensor;
    entry["every"] = FormatNumber(withholding.every) + " s";
    entry["length"] = FormatNumber(withholding.length) + " s";
    if (withholding.from) {
      entry["from"] = FormatNumber(*withholding.from) + " s";
    }
    list.push_back(entry);
  }
  top["withhold"] = list;
  resolved->yaml = Emit(top);
}

void WriteResolvedConfig(const ResolvedConfig& resolved,
                         const std::string& path) {
  WriteFileAtomically(
      path,
      "# What was used, in SI units, defaults included.\n" + resolved.yaml);
}

}  // namespace hindsight
