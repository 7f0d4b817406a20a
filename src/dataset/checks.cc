#include "dataset/checks.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "base/median.h"
#include "base/units.h"
#include "dataset/gyro_unit.h"
#include "dataset/imu_cells.h"
#include "dataset/magnetic_check.h"
#include "dataset/repeated_readings.h"
#include "dataset/stamp_check.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr double kForceTolerance = 0.05;
constexpr double kMaxRestRate = 2.0 * kDegree;
constexpr double kMaxForce = 200.0;
constexpr double kMaxRate = 35.0;

/// Means over spans of time, of readings in time order.
class SpanMean {
 public:
  explicit SpanMean(const std::vector<TimeInterval>& spans) : spans_(spans) {}

  void Add(double t, double dt, const Eigen::Vector3d& f,
           const Eigen::Vector3d& w) {
    while (next_ < spans_.size() && spans_[next_].end < t) ++next_;
    if (next_ == spans_.size() || t <= spans_[next_].begin) return;
    force_ += dt * f;
    rate_ += dt * w;
    weight_ += dt;
  }

  std::optional<Eigen::Vector3d> force() const { return Mean(force_); }
  std::optional<Eigen::Vector3d> rate() const { return Mean(rate_); }

 private:
  std::optional<Eigen::Vector3d> Mean(const Eigen::Vector3d& sum) const {
    if (weight_ <= 0.0) return std::nullopt;
    return sum / weight_;
  }

  const std::vector<TimeInterval>& spans_;
  std::size_t next_ = 0;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();
  double weight_ = 0.0;
};

/// The mean of the specific force over the second in which it varies least.
class QuietestSecond {
 public:
  void Add(double dt, const Eigen::Vector3d& f) {
    sum_ += dt * f;
    squares_ += dt * f.squaredNorm();
    duration_ += dt;
    if (duration_ >= 1.0) End();
  }

  /// Of a shorter record, the mean over all of it.
  Eigen::Vector3d mean() const {
    return std::isfinite(least_) ? mean_ : Eigen::Vector3d(sum_ / duration_);
  }

 private:
  void End() {
    const Eigen::Vector3d mean = sum_ / duration_;
    const double variance = squares_ / duration_ - mean.squaredNorm();
    if (variance < least_) {
      least_ = variance;
      mean_ = mean;
    }
    sum_.setZero();
    squares_ = duration_ = 0.0;
  }

  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  double squares_ = 0.0;
  double duration_ = 0.0;
  double least_ = std::numeric_limits<double>::infinity();
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();
};

std::vector<TimeInterval> AllSpans(const Rest& rest) {
  std::vector<TimeInterval> all = rest.at_rest;
  all.insert(all.end(), rest.moving.begin(), rest.moving.end());
  all.insert(all.end(), rest.undecided.begin(), rest.undecided.end());
  std::sort(all.begin(), all.end(),
            [](const TimeInterval& a, const TimeInterval& b) {
              return a.begin < b.begin;
            });
  return all;
}

ImuReport ReportImu(const Dataset& dataset) {
  ImuReport report;
  const ImuStream& imu = dataset.imu;
  report.rest = FindRest(dataset);
  const std::vector<TimeInterval> all = AllSpans(report.rest);
  SpanMean rest(report.rest.at_rest);
  SpanMean still(all);
  QuietestSecond quietest;
  double duration = 0.0;
  for (std::size_t k = 1; k < imu.samples.size(); ++k) {
    const ImuSample& sample = imu.samples[k];
    const double dt = sample.t - imu.samples[k - 1].t;
    const double scale =
        imu.kind == ImuStream::Kind::kIncrements ? 1.0 / dt : 1.0;
    const Eigen::Vector3d f = scale * sample.accel;
    const Eigen::Vector3d w = scale * sample.gyro;
    report.mean_force += dt * f.norm();
    report.mean_force_b += dt * f;
    duration += dt;
    report.max_force = std::max(report.max_force, f.norm());
    report.max_rate = std::max(report.max_rate, w.norm());
    quietest.Add(dt, f);
    rest.Add(sample.t, dt, f, w);
    still.Add(sample.t, dt, f, w);
  }
  report.mean_force /= duration;
  report.mean_force_b /= duration;
  report.quietest_force = quietest.mean();
  report.rest_force = rest.force();
  report.rest_rate = rest.rate();
  report.still_force = still.force();
  return report;
}

/// Unaccelerated, the specific force is 1 g upwards: (0, 0, -g) in
/// forward-right-down.
std::string SuggestAxes(const Eigen::Vector3d& force, std::string* axes) {
  struct Case {
    Eigen::Vector3d up;
    const char* looks;
    const char* axes;
  };
  static const std::array<Case, 6> kCases = {{
      {{0, 0, -1}, "z points down, as it should", ""},
      {{0, 0, 1}, "z points up: this looks forward-left-up", "[x, -y, -z]"},
      {{1, 0, 0}, "x points up", "[z, y, -x]"},
      {{-1, 0, 0}, "x points down", "[-z, y, x]"},
      {{0, 1, 0},
       "y points up: this looks "
       "forward-up-right",
       "[x, z, -y]"},
      {{0, -1, 0},
       "y points down: this looks like a camera's axes",
       "[z, x, y]"},
  }};
  const Eigen::Vector3d direction = force.normalized();
  const Case* best = &kCases[0];
  for (const Case& candidate : kCases) {
    if (candidate.up.dot(direction) > best->up.dot(direction)) {
      best = &candidate;
    }
  }
  const double tilt =
      std::acos(std::min(1.0, best->up.dot(direction))) / kDegree;
  *axes = best->axes;
  std::string text = best->looks;
  if (*best->axes != '\0') {
    text += std::string("; axes: ") + best->axes +
            ", applied after those declared, makes z point down (gravity says "
            "nothing about which way is forward)";
  }
  return text + fmt::format("; tilt against that axis {:.1f} deg", tilt);
}

void SetAxes(CheckReport* report) {
  constexpr double kUpright = 0.7;
  const ImuReport& imu = report->imu;
  if (imu.still_force) {
    report->axes = SuggestAxes(*imu.still_force, &report->suggested_axes);
  } else if (imu.mean_force_b.norm() > kUpright * imu.mean_force) {
    report->axes = SuggestAxes(imu.mean_force_b, &report->suggested_axes) +
                   ", by the mean specific force, as it never stands";
  } else {
    report->axes =
        "unknown: it never stands, and no axis feels gravity on average; "
        "expected a second of rest, or `axes` as the sensor is mounted";
  }
}

void WarnAboutImu(const CheckReport& report, const ImuStream& stream,
                  std::vector<std::string>* warnings) {
  const ImuReport& imu = report.imu;
  const double force =
      imu.rest_force ? imu.rest_force->norm() : imu.quietest_force.norm();
  const char* where = imu.rest_force ? "at rest" : "where it varies least";
  const double tolerance =
      imu.rest_force ? kForceTolerance : 4 * kForceTolerance;
  if (std::abs(force / kStandardGravity - 1.0) > tolerance) {
    warnings->push_back(fmt::format(
        "imu: |f| is {:.4g} m/s^2 {}, expected about 9.81: check the unit "
        "of the accelerometer{}",
        force, where,
        stream.kind == ImuStream::Kind::kIncrements
            ? " and whether these are increments"
            : ", or whether these are increments"));
  }
  if (imu.max_force > kMaxForce) {
    warnings->push_back(fmt::format(
        "imu: |f| reaches {:.4g} m/s^2: check the unit", imu.max_force));
  }
  if (imu.max_rate > kMaxRate) {
    warnings->push_back(
        fmt::format("imu: |w| reaches {:.4g} deg/s: check the unit",
                    imu.max_rate / kDegree));
  }
  if (imu.rest_force && imu.rest_force->normalized().z() > -0.7) {
    warnings->push_back("imu: z does not point down at rest: " + report.axes);
  }
}

/// A constant rate that the given bias does not explain.
void WarnAboutRate(const Dataset& dataset, const ImuReport& imu,
                   std::vector<std::string>* warnings) {
  if (imu.rest_rate) {
    const double rate = (*imu.rest_rate - dataset.initial.gyro_bias).norm();
    if (rate <= kMaxRestRate) return;
    warnings->push_back(fmt::format(
        "imu: |w| is {:.3g} deg/s at rest: a large bias, or the wrong "
        "unit of the gyro",
        rate / kDegree));
    return;
  }
  constexpr double kLong = 5.0;
  const UnexplainedRate rate = FindUnexplainedRate(dataset);
  if (imu.still_force || rate.seconds < kLong) return;
  warnings->push_back(fmt::format(
      "imu: for {:.1f} s nothing shakes it and the gyros read up to {:.3g} "
      "deg/s, "
      "more than initial.gyro_bias and its sigma allow: a steady turn; or, if "
      "it stands there, a bias to be given or the wrong unit of the gyro",
      rate.seconds, rate.rate / kDegree));
}

void WarnAboutStream(const StreamReport& stream,
                     std::vector<std::string>* warnings) {
  if (stream.rate > 0.0 && stream.delay * stream.rate > kMaxJitter) {
    warnings->push_back(fmt::format(
        "{}: intervals vary by {:.3g} s about {:.3g} s: are the stamps those "
        "of reception?",
        stream.name, stream.delay, 1.0 / stream.rate));
  }
  const double span = stream.t_end - stream.t_begin;
  if (span > 0.0 && stream.overlap < 0.5 * span) {
    warnings->push_back(
        fmt::format("{}: only {:.1f} s of {:.1f} s lie within the IMU's "
                    "record",
                    stream.name, stream.overlap, span));
  }
}

}  // namespace

Grade CheckReport::grade() const {
  if (streams.empty()) return Grade::kUnusable;
  return std::max(GradeOf(evidence),
                  warnings.empty() ? Grade::kUsable : Grade::kDoubtful);
}

CheckReport CheckDataset(const Dataset& dataset) {
  CheckReport report;
  if (dataset.imu.empty()) {
    report.warnings.emplace_back("imu: fewer than two samples");
    return report;
  }
  report.streams.push_back(
      ReportStamps("imu", ImuStamps(dataset.imu), dataset.imu));
  std::vector<double> stamps;
  for (const AidingStream& stream : dataset.streams) {
    stamps.clear();
    for (const Measurement& z : stream.measurements) {
      stamps.push_back(z.t + stream.sensor.time_offset);
    }
    report.streams.push_back(
        ReportStamps(stream.sensor.name, stamps, dataset.imu));
    if (stream.sensor.kind->standing) {
      report.streams.back().jitter = report.streams.back().delay =
          0.0;  // they come when the vehicle rests
    }
  }
  report.imu = ReportImu(dataset);
  SetAxes(&report);
  WarnAboutImu(report, dataset.imu, &report.warnings);
  WarnAboutRate(dataset, report.imu, &report.warnings);
  if (const std::string warning = WarnAboutGyroUnit(dataset);
      !warning.empty()) {
    report.warnings.push_back(warning);
  }
  for (const StreamReport& stream : report.streams) {
    WarnAboutStream(stream, &report.warnings);
  }
  if (!dataset.truth.empty()) {
    stamps.clear();
    for (const TruthPoint& point : dataset.truth) stamps.push_back(point.t);
    report.streams.push_back(ReportStamps("truth", stamps, dataset.imu));
    WarnAboutStream(report.streams.back(), &report.truth_warnings);
  }
  report.evidence =
      FindRepeatedReadings(dataset, dataset.imu.t_begin(), dataset.imu.t_end());
  for (std::string& warning : CheckMagnetometers(dataset)) {
    report.warnings.push_back(std::move(warning));
  }
  if (dataset.streams.empty()) {
    report.warnings.emplace_back("no aiding stream: the position will drift");
  }
  return report;
}

}  // namespace hindsight
