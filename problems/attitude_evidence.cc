#include "problems/attitude_evidence.h"

#include <fmt/core.h>

#include <cmath>
#include <string>
#include <utility>

#include "base/median.h"
#include "base/units.h"
#include "dataset/bias_sigma.h"
#include "dataset/magnetic_check.h"
#include "dataset/repeated_readings.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"
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

namespace {

/// Doubtful where the accelerometer's median is less than half or more than
/// twice gravity: attitude alone needs no more than its direction, and so nothing
/// else hears of another unit.
void ExamineGravity(const ImuStream& imu, double gravity,
                    std::vector<Evidence>* evidence) {
  constexpr double kFar = 2.0;
  constexpr std::size_t kMost = 100000;
  const std::size_t stride = imu.samples.size() / kMost + 1;
  std::vector<double> norms;
  for (std::size_t k = 0; k < imu.samples.size(); k += stride) {
    norms.push_back(imu.samples[k].accel.norm());
  }
  const double ratio = Median(std::move(norms)) / gravity;
  if (ratio > 1.0 / kFar && ratio < kFar) return;
  evidence->push_back(
      {.rule = "gravity",
       .grade = Grade::kDoubtful,
       .what = fmt::format(
           "the specific force is {:.3g} times gravity in the median", ratio),
       .value = ratio,
       .limit = ratio > 1.0 ? kFar : 1.0 / kFar,
       .unit = "1",
       .causes =
           {"the unit of the accelerometers, or columns that are not theirs"},
       .remedies = {"another unit in imu.columns"},
       .is_cause = true});
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

std::optional<Evidence> AttitudeComparison::Compare(
    const Solution& solution, const Eigen::Quaterniond& q_en) {
  constexpr std::size_t kMost = 20000;
  if (solution.covariances.empty()) return std::nullopt;
  Course own{.method = solution.method};
  const std::size_t stride = solution.states.size() / kMost + 1;
  for (std::size_t k = 0; k < solution.states.size(); k += stride) {
    own.q_nb.push_back(q_en.conjugate() * solution.states[k].q_eb);
    own.variances.emplace_back(
        solution.covariances.Get(k).diagonal().head<3>());
  }
  std::optional<Evidence> found;
  for (const Course& other : courses_) {
    if (other.q_nb.size() != own.q_nb.size()) continue;
    Eigen::Vector3d squares = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < own.q_nb.size(); ++k) {
      const Eigen::Vector3d psi = Log(other.q_nb[k] * own.q_nb[k].conjugate());
      squares += psi.cwiseAbs2().cwiseQuotient(
          own.variances[k].cwiseMax(other.variances[k]));
    }
    const double sigmas =
        std::sqrt(squares.maxCoeff() / static_cast<double>(own.q_nb.size()));
    if (!(sigmas > kUnusableBias)) continue;
    found = Evidence{
        .rule = "disagreement",
        .grade = Grade::kDoubtful,
        .what =
            fmt::format("{} and {} are {:.2g} sigma of the less certain one "
                        "apart in attitude",
                        other.method, own.method, sigmas),
        .value = sigmas,
        .limit = kUnusableBias,
        .unit = "sigma",
        .causes =
            {"readings that contradict each other, or sigmas that are too "
             "small"},
        .against = other.method};
  }
  courses_.push_back(std::move(own));
  return found;
}

std::vector<Evidence> AttitudeEstimation::ExamineRecording() const {
  std::vector<Evidence> recording =
      FindRepeatedReadings(dataset_, imu_.t_begin(), imu_.t_end());
  ExamineGravity(imu_, filter_options_.place.gravity, &recording);
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
