#include "problems/attitude_evidence.h"

#include <fmt/core.h>

#include <string>
#include <utility>

#include "base/median.h"
#include "base/units.h"
#include "dataset/bias_sigma.h"
#include "dataset/magnetic_check.h"
#include "dataset/repeated_readings.h"
#include "earth/wgs84.h"
#include "problems/attitude.h"

namespace hindsight {

std::vector<Sensor> JudgedSources() {
  std::vector<Sensor> sources(4);
  // That what the body accelerates averages out is the model of this one.
  sources[0].name = "the accelerometer";
  sources[1].name = "the velocities";
  sources[2].name = "the headings";
  sources[3].name = "the magnetometer";
  return sources;
}

std::vector<NormalisedInnovation> InnovationsOf(const AttitudeRun& run) {
  constexpr double kTicks = 1e6;  // a second
  std::vector<NormalisedInnovation> innovations;
  innovations.reserve(run.innovations.size());
  for (const AttitudeInnovation& innovation : run.innovations) {
    NormalisedInnovation& one = innovations.emplace_back();
    one.t = innovation.t;
    one.sensor = static_cast<int>(innovation.source);
    one.index = static_cast<std::size_t>(
        std::llround(kTicks * (innovation.t - run.innovations.front().t)));
    one.rows = innovation.rows;
    one.white = innovation.rows;
  }
  return innovations;
}

bool IsOtherUnit(double ratio) {
  return !(ratio > 1.0 / kOtherUnit && ratio < kOtherUnit);
}

double MedianForce(const ImuStream& imu) {
  constexpr std::size_t kMost = 100000;
  const std::size_t stride = imu.samples.size() / kMost + 1;
  std::vector<double> norms;
  for (std::size_t k = 0; k < imu.samples.size(); k += stride) {
    norms.push_back(imu.samples[k].accel.norm());
  }
  return Median(std::move(norms));
}

double UsualTiltSigma(const Solution& solution) {
  constexpr std::size_t kMost = 10000;
  const std::size_t stride = solution.states.size() / kMost + 1;
  std::vector<double> variances;
  for (std::size_t k = 0; k < solution.states.size(); k += stride) {
    const ErrorMatrix P = solution.covariances.Get(k);
    variances.push_back(std::max(P(0, 0), P(1, 1)));
  }
  return std::sqrt(Median(std::move(variances)));
}

namespace {

/// Doubtful where the accelerometer's median, `ratio` times gravity, IsOtherUnit:
/// attitude alone needs no more than its direction, and so nothing else hears of
/// another unit.
void ExamineGravity(double ratio, std::vector<Evidence>* evidence) {
  if (!IsOtherUnit(ratio)) return;
  evidence->push_back(
      {.rule = "gravity",
       .grade = Grade::kDoubtful,
       .what = fmt::format("the specific force is {:.3g} times gravity in the "
                           "median: its direction alone is used",
                           ratio),
       .value = ratio,
       .limit = ratio > 1.0 ? kOtherUnit : 1.0 / kOtherUnit,
       .unit = "1",
       .causes =
           {"the unit of the accelerometers, or columns that are not theirs"},
       .remedies = {"another unit in imu.columns"},
       .is_cause = true});
}

/// An error of a magnetometer goes on for `correlation_time` anyway, in which its
/// readings count as one: those that are new more often than that are late where
/// rows repeat them, but not counted too often.
void ForgiveStaleRows(const AidingStream& magnetometer, double correlation_time,
                      std::vector<Evidence>* evidence) {
  const auto& rows = magnetometer.measurements;
  const double fresh =
      static_cast<double>(rows.size()) * (1.0 - StaleShare(magnetometer));
  if (rows.back().t - rows.front().t > correlation_time * fresh) return;
  const std::string about = magnetometer.sensor.name + " ";
  for (Evidence& found : *evidence) {
    if (found.rule == "stale_readings" && found.what.starts_with(about)) {
      found.grade = Grade::kDoubtful;
    }
  }
}

}  // namespace

StartValues StartOf(const ErrorLayout& layout, const AttitudeState::Matrix& P,
                    const State& x, const InitialState& given) {
  StartValues values;
  values.x = x;
  values.P = P.topLeftCorner(layout.dim(), layout.dim());
  // That headings count from there is no knowledge that could be wrong.
  constexpr double kExact = 1e-4;
  if (values.P(2, 2) < kExact * kExact) values.P(2, 2) = kPi * kPi;
  values.given = given;
  values.alignment = "of attitude alone";
  return values;
}

std::vector<Evidence> AttitudeEstimation::ExamineRecording() const {
  std::vector<Evidence> recording =
      FindRepeatedReadings(dataset_, imu_.t_begin(), imu_.t_end());
  if (const AidingStream* magnetometer = MagnetometerOf(dataset_)) {
    ForgiveStaleRows(*magnetometer, filter_options_.magnetic_correlation_time,
                     &recording);
  }
  ExamineGravity(force_ratio_, &recording);
  recording.insert(recording.end(), evidence_.begin(), evidence_.end());
  for (std::string& warning : CheckMagnetometers(dataset_)) {
    recording.push_back({.rule = "magnetic_field",
                         .grade = Grade::kDoubtful,
                         .what = std::move(warning),
                         .is_cause = true});
  }
  if (!RoughPosition(dataset_) &&
      GyroBiasSigma(dataset_.initial).maxCoeff() < kEarthRate) {
    recording.push_back(
        {.rule = "unknown_place",
         .grade = Grade::kDoubtful,
         .what =
             "nothing says where on the Earth this is, and it turns by more "
             "than gyro_bias_sigma leaves open: 15 deg/h",
         .remedies = {"place: [lat, lon, h]"}});
  }
  if (velocities_.empty() && !VelocitySamples(dataset_).empty()) {
    recording.push_back(
        {.rule = "unused_velocities",
         .grade = Grade::kDoubtful,
         .what = "velocities that nothing tells the heading of are not used: "
                 "the tilt is wrong by whatever the body accelerates",
         .remedies = {"initial.heading, a magnetometer or headings"}});
  }
  return recording;
}

}  // namespace hindsight
