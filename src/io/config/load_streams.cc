#include "io/config/load_streams.h"

#include <fmt/core.h>

#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "dataset/clock_search.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

std::string SpanText(double begin, double end) {
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
      source.name + " (" + source.path + ") covers " + SpanText(begin, end) +
          " and the IMU " + SpanText(imu.t_begin(), imu.t_end()) +
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
                       SpanText(imu.t_begin(), imu.t_end()) +
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

void AddPolicies(const std::vector<PolicyCount>& policies, Dataset* dataset) {
  dataset->policies.insert(dataset->policies.end(), policies.begin(),
                           policies.end());
}

void LoadAiding(const AidingConfig& config, double truth_offset,
                const ClockMap& imu_clock, StreamsBeside* beside,
                Dataset* dataset) {
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
  RowsOfFile<MeasurementSeries> read =
      beside->Aiding(static_cast<std::size_t>(index));
  AddPolicies(read.policies, dataset);
  stream.measurements = std::move(read.rows);
  const TimeLine line =
      MapClock(config.source, read.clock, dataset->epoch_gps_ns);
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

/// The whole second at which the stream begins, if it knows GPS time.
std::optional<std::int64_t> EpochOf(const StreamSource& source,
                                    const StreamClock& clock) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  const auto first = FirstGpsTime(source, clock);
  if (!first) return std::nullopt;
  return Nanoseconds(*first) / kSecond * kSecond;
}

}  // namespace

void LoadImu(const DeclaredRecording& declared, ConfigMap* top,
             Dataset* dataset) {
  StreamClock clock;
  const ImuNoise noise = dataset->imu.noise;
  ImuReadOptions options = declared.imu_options;
  const auto place = [&](const StreamClock& known) {
    if (!dataset->epoch_gps_ns) {
      dataset->epoch_gps_ns = EpochOf(declared.imu, known);
    }
    return MapClock(declared.imu, known, dataset->epoch_gps_ns);
  };
  const bool ends_late = declared.imu.clock.duration.has_value();
  if (!ends_late) options.place = place;
  dataset->imu = ReadImu(declared.imu, options, &clock, &dataset->policies);
  dataset->imu.noise = noise;
  top->resolved()["imu"]["kind"] =
      dataset->imu.kind == ImuStream::Kind::kRates ? "rates" : "increments";
  if (ends_late) {
    const TimeLine line = place(clock);
    for (ImuSample& sample : dataset->imu.samples) sample.t = line(sample.t);
  }
  if (dataset->epoch_gps_ns) {
    top->Resolve("epoch", FormatGpsTime(*dataset->epoch_gps_ns));
  }
  RequireModestSpan(declared.imu, dataset->imu);
  dataset->imu.stamp_offset = declared.imu.clock.offset;
  dataset->imu.nominal_dt = MedianInterval(dataset->imu);
}

StreamSource StreamsBeside::Abandonable(StreamSource source) const {
  source.abandoned = &abandoned_;
  return source;
}

StreamsBeside::StreamsBeside(const DeclaredRecording& declared) {
  if (declared.truth) {
    truth_ = std::packaged_task<RowsOfFile<TruthSeries>()>([this, &declared] {
      RowsOfFile<TruthSeries> read;
      read.rows =
          ReadTruth(Abandonable(*declared.truth), declared.truth_options,
                    &read.clock, &read.policies);
      return read;
    });
  }
  for (const AidingConfig& config : declared.aiding) {
    const auto index = static_cast<int>(aiding_.size());
    aiding_.emplace_back([this, &config, index] {
      RowsOfFile<MeasurementSeries> read;
      if (config.settings.sensor.kind->generated) return read;
      read.rows = ReadAiding(Abandonable(config.source), config.settings, index,
                             &read.clock, &read.policies);
      return read;
    });
  }
  reading_ = InBackground([this] {
    if (truth_.valid()) truth_();
    for (auto& read : aiding_) {
      if (!abandoned_) read();
    }
  });
}

RowsOfFile<TruthSeries> StreamsBeside::Truth() {
  reading_.wait();
  return truth_.get_future().get();
}

RowsOfFile<MeasurementSeries> StreamsBeside::Aiding(std::size_t index) {
  reading_.wait();
  return aiding_[index].get_future().get();
}

double LoadTruth(const DeclaredRecording& declared, StreamsBeside* beside,
                 Dataset* dataset) {
  if (!declared.truth) return 0.0;
  RowsOfFile<TruthSeries> read = beside->Truth();
  AddPolicies(read.policies, dataset);
  dataset->truth = std::move(read.rows);
  const TimeLine line =
      MapClock(*declared.truth, read.clock, dataset->epoch_gps_ns);
  for (TruthPoint& point : dataset->truth.Edited()) point.t = line(point.t);
  const double offset = declared.truth_clock_unknown
                            ? FitTruthClock(*declared.truth, dataset)
                            : declared.truth->clock.offset;
  RequireOverlap(*declared.truth, dataset->imu, dataset->truth.front().t,
                 dataset->truth.back().t);
  return offset;
}

void LoadAidingStreams(const DeclaredRecording& declared, double truth_offset,
                       StreamsBeside* beside, Dataset* dataset) {
  for (const AidingConfig& config : declared.aiding) {
    LoadAiding(config, truth_offset, declared.imu.clock, beside, dataset);
  }
  for (std::size_t i = 0; i < declared.aiding.size(); ++i) {
    AddLevel(declared.aiding[i].settings, static_cast<int>(i), dataset);
  }
}

}  // namespace hindsight
