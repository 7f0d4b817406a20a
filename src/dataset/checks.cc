#include "dataset/checks.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/units.h"
#include "dataset/gyro_unit.h"
#include "dataset/imu_cells.h"
#include "dataset/magnetic_check.h"
#include "dataset/repeated_readings.h"
#include "dataset/stamp_check.h"
#include "dataset/wheel_speed.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr double kForceTolerance = 0.05;
constexpr double kMaxRestRate = 2.0 * kDegree;
constexpr double kMaxForce = 200.0;
constexpr double kMaxRate = 35.0;

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
  } else if (imu.record.mean_force_b.norm() >
             kUpright * imu.record.mean_force) {
    report->axes =
        SuggestAxes(imu.record.mean_force_b, &report->suggested_axes) +
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
  const double force = imu.rest_force ? imu.rest_force->norm()
                                      : imu.record.quietest_force.norm();
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
  if (imu.record.max_force > kMaxForce) {
    warnings->push_back(fmt::format(
        "imu: |f| reaches {:.4g} m/s^2: check the unit", imu.record.max_force));
  }
  if (imu.record.max_rate > kMaxRate) {
    warnings->push_back(
        fmt::format("imu: |w| reaches {:.4g} deg/s: check the unit",
                    imu.record.max_rate / kDegree));
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

/// What stamps are whose stream is `ratio` times as long as the IMU's, as a
/// clause; "" if no unit of time makes it as long to a tenth.
std::string UnitOfStamps(double ratio) {
  struct Unit {
    double ratio;
    const char* text;
  };
  constexpr std::array kUnits = {
      Unit{1e3, "its stamps may be ms"},
      Unit{1e6, "its stamps may be us"},
      Unit{1e9, "its stamps may be ns"},
      Unit{1e-3, "the IMU's may be ms, or its own longer than they say"},
      Unit{1e-6, "the IMU's may be us, or its own longer than they say"},
      Unit{1e-9, "the IMU's may be ns, or its own longer than they say"}};
  for (const Unit& unit : kUnits) {
    if (std::abs(ratio / unit.ratio - 1.0) < 0.1) {
      return std::string("; ") + unit.text;
    }
  }
  return "";
}

/// A wheel that counts backward, or at another rate than the positions move by more
/// than a scale factor would.
void WarnAboutWheels(const Dataset& dataset,
                     std::vector<std::string>* warnings) {
  constexpr double kUsualScale = 0.3;
  for (const AidingStream& stream : dataset.streams) {
    if (stream.sensor.kind != &OdometerKind()) continue;
    const auto wheel = FindWheel(stream, dataset);
    const double forward =
        (stream.sensor.q_sb.conjugate() * Eigen::Vector3d::UnitX()).x();
    const double factor =
        wheel ? std::copysign(1.0, forward) * wheel->factor : 1.0;
    if (std::abs(factor - 1.0) < kUsualScale) continue;
    warnings->push_back(fmt::format(
        "{}: the positions move {:.3g} times as fast as it says: {}",
        stream.sensor.name, factor,
        factor < 0.0
            ? "its sign is the other; put a \"-\" before its column under "
              "`columns`, or turn its mounting"
            : "correct its unit or its scale under `columns`"));
  }
}

void WarnAboutStream(const StreamReport& stream, const StreamReport& imu,
                     std::vector<std::string>* warnings) {
  if (stream.rate > 0.0 && stream.delay * stream.rate > kMaxJitter) {
    warnings->push_back(fmt::format(
        "{}: intervals vary by {:.3g} s about {:.3g} s: are the stamps those "
        "of reception?",
        stream.name, stream.delay, 1.0 / stream.rate));
  }
  const double span = stream.t_end - stream.t_begin;
  constexpr long kMany = 20;
  const std::string unit = UnitOfStamps(span / (imu.t_end - imu.t_begin));
  if (span > 0.0 && span < 0.1 * (imu.t_end - imu.t_begin) &&
      stream.count > kMany && !unit.empty()) {
    warnings->push_back(fmt::format(
        "{}: {} rows in {:.3g} s of the IMU's "
        "{:.1f} s{}",
        stream.name, stream.count, span, imu.t_end - imu.t_begin, unit));
  }
  if (span > 0.0 && stream.overlap < 0.5 * span) {
    warnings->push_back(
        fmt::format("{}: only {:.1f} s of {:.1f} s lie within the IMU's "
                    "record{}",
                    stream.name, stream.overlap, span, unit));
  }
}

}  // namespace

Grade CheckReport::grade() const {
  if (streams.empty()) return Grade::kUnusable;
  return std::max(GradeOf(evidence),
                  warnings.empty() ? Grade::kUsable : Grade::kDoubtful);
}

CheckReport DescribeDataset(const Dataset& dataset, const RestMemo& rests) {
  CheckReport report;
  if (dataset.imu.empty()) {
    report.warnings.emplace_back("imu: fewer than two samples");
    return report;
  }
  report.streams.push_back(ReportImuStamps(dataset.imu));
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
  report.imu = ReportImu(dataset, rests);
  SetAxes(&report);
  WarnAboutImu(report, dataset.imu, &report.warnings);
  WarnAboutRate(dataset, report.imu, &report.warnings);
  if (const std::string warning = WarnAboutGyroUnit(dataset);
      !warning.empty()) {
    report.warnings.push_back(warning);
  }
  WarnAboutWheels(dataset, &report.warnings);
  for (const StreamReport& stream : report.streams) {
    WarnAboutStream(stream, report.streams.front(), &report.warnings);
  }
  if (!dataset.truth.empty()) {
    stamps.clear();
    for (const TruthPoint& point : dataset.truth) stamps.push_back(point.t);
    report.streams.push_back(ReportStamps("truth", stamps, dataset.imu));
    WarnAboutStream(report.streams.back(), report.streams.front(),
                    &report.truth_warnings);
  }
  for (std::string& warning : CheckMagnetometers(dataset)) {
    report.warnings.push_back(std::move(warning));
  }
  if (dataset.streams.empty()) {
    report.warnings.emplace_back("no aiding stream: the position will drift");
  }
  return report;
}

CheckReport CheckDataset(const Dataset& dataset) {
  CheckReport report = DescribeDataset(dataset, RestMemo(dataset));
  if (dataset.imu.empty()) return report;
  report.evidence =
      FindRepeatedReadings(dataset, dataset.imu.t_begin(), dataset.imu.t_end());
  return report;
}

}  // namespace hindsight
