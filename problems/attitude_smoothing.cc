#include <fmt/core.h>

#include <cmath>
#include <optional>
#include <utility>

#include "alignment/attitude_rest.h"
#include "base/units.h"
#include "evaluation/explanation.h"
#include "evaluation/given_values.h"
#include "geometry/so3.h"
#include "problems/attitude.h"
#include "problems/attitude_evidence.h"

namespace hindsight {

AttitudeEstimation::Pass AttitudeEstimation::Smooth(
    const AttitudeState& start, std::span<const BiasedForce> forces,
    std::span<const MagneticSample> magnetic,
    const AttitudeFilterOptions& options, const std::string& stage,
    bool covariances) const {
  Pass pass;
  pass.run = RunAttitudeFilter(
      imu_, {magnetic, headings_, velocities_, forces}, options, start,
      /*to_be_smoothed=*/true, [&](std::size_t k) {
        Poll(stage,
             static_cast<double>(k) / static_cast<double>(imu_.samples.size()));
      });
  pass.smoothed = SmoothAttitude(pass.run, covariances);
  return pass;
}

AttitudeEstimation::Pass AttitudeEstimation::SmoothWithoutSurvey(
    std::span<const BiasedForce> forces,
    const AttitudeFilterOptions& options) const {
  return Smooth(start_, forces, magnetic_, options, "ahrs_smoother",
                /*covariances=*/true);
}

namespace {

/// Doubtful where it leaves more open than what surrounds a sensor does.
std::optional<Evidence> TwoNorths(const FieldSurvey& survey) {
  constexpr double kSurroundings = 2.0 * kDegree;
  const double sigma = NorthSigma(survey);
  if (sigma <= kSurroundings) return std::nullopt;
  return Evidence{
      .rule = "two_norths",
      .grade = Grade::kDoubtful,
      .what = fmt::format("the field in motion points {:.1f} deg elsewhere "
                          "than at rest: which is north is not known",
                          std::abs(survey.turn) / kDegree),
      .value = sigma / kDegree,
      .limit = kSurroundings / kDegree,
      .unit = "deg",
      .causes = {"a magnet or iron where the sensor rests or is moved"},
      .remedies = {"another place, or headings of another sensor"}};
}

/// Doubtful where its axes are turned, or its readings scatter by more than their
/// stated sigma explains.
void JudgeMagnetometer(const MagnetometerErrors& found, const Sensor& sensor,
                       double sigma, std::vector<Evidence>* evidence) {
  if (!found.turn_b.isZero(0.0)) {
    const Eigen::Vector3d turn = found.turn_b / kDegree;
    evidence->push_back(
        {.rule = "magnetometer",
         .grade = Grade::kDoubtful,
         .what = fmt::format("the readings of '{}' fit the gyros if they are "
                             "turned by {:.1f}, {:.1f}, {:.1f} deg about the "
                             "body's axes",
                             sensor.name, turn.x(), turn.y(), turn.z()),
         .value = turn.norm(),
         .limit = kLeastTurn / kDegree,
         .unit = "deg",
         .causes = {"a magnetometer that is mounted askew"},
         .remedies = {"its mounting, turned back by as much"},
         .is_cause = true});
  }
  if (found.scatter && *found.scatter > kDoubtfulError * sigma) {
    evidence->push_back(
        {.rule = "magnetometer",
         .grade = Grade::kDoubtful,
         .what =
             fmt::format("the field that '{}' reads scatters by {:.2g} uT "
                         "an axis as the body moves, {:.2g} times what its "
                         "sigma says",
                         sensor.name, *found.scatter, *found.scatter / sigma),
         .value = *found.scatter / sigma,
         .limit = kDoubtfulError,
         .unit = "1",
         .causes = {"iron or magnets around", "too small a sigma"},
         .remedies = {"sigma: " + fmt::format("{:.2g} uT", *found.scatter)}});
  }
}

/// Doubtful where its readings fit the gyros significantly better at another time
/// than they are stamped, and the body turns by a stated sigma of the attitude
/// meanwhile: one of the two clocks is off.
void JudgeMagneticClock(const MagnetometerErrors& found, const Sensor& sensor,
                        const ImuStream& imu, double sigma,
                        std::vector<Evidence>* evidence) {
  const double sigmas =
      std::abs(found.apparent_offset) / found.apparent_offset_sigma;
  double squares = 0.0;
  for (const ImuSample& sample : imu.samples) {
    squares += sample.gyro.squaredNorm();
  }
  const double rate =
      std::sqrt(squares / static_cast<double>(imu.samples.size()));
  if (!(sigmas > StrainLimit(1)) ||
      !(std::abs(found.apparent_offset) * rate > kDoubtfulShift * sigma)) {
    return;
  }
  evidence->push_back(
      {.rule = "magnetometer",
       .grade = Grade::kDoubtful,
       .what = fmt::format(
           "the readings of '{}' fit the gyros {:.2g} s {} than "
           "they are stamped, by {:.1f} sigma",
           sensor.name, std::abs(found.apparent_offset),
           found.apparent_offset < 0.0 ? "earlier" : "later", sigmas),
       .value = sigmas,
       .limit = StrainLimit(1),
       .unit = "sigma",
       .causes = {"a clock or delay of '" + sensor.name + "', or of the IMU"},
       .remedies = {"estimate.time_offset of '" + sensor.name + "'",
                    "imu.time_offset, or another imu.kind"},
       .is_cause = true});
}

}  // namespace

Solution AttitudeEstimation::Smoother() {
  AttitudeFilterOptions options = filter_options_;
  if (rests_.empty() && options.rest_sigma > 0.0) {
    rests_ = RestsBetweenSamples(dataset_, imu_, start_);
  }
  rests_.resize(imu_.samples.size());
  options.rests = rests_;
  // Velocities are of the forces as they were read.
  const bool average = !dataset_.ahrs.low_pass && options.low_pass_tau > 0.0 &&
                       velocities_.empty();
  const bool survey = dataset_.ahrs.survey && !magnetic_.empty();
  if (!average && !survey) {
    return SolutionOf(SmoothWithoutSurvey({}, options));
  }
  const Pass first =
      Smooth(start_, {}, {}, options, "survey", /*covariances=*/false);
  const std::vector<Eigen::Quaterniond> level =
      AttitudesAtSamples(first.run, first.smoothed, imu_);
  // A smoother may use what comes later.
  std::vector<BiasedForce> forces;
  if (average) {
    forces = AveragedForce(imu_, level, options.low_pass_tau);
    options.low_pass_tau = 0.0;
  }
  const Pass pass = survey ? SmoothSurveyed(forces, level, options)
                           : SmoothWithoutSurvey(forces, options);
  if (const auto evidence = TwoNorths(pass.survey)) {
    evidence_.push_back(*evidence);
  }
  if (survey) {
    JudgeMagnetometer(pass.magnetometer, MagnetometerOf(dataset_)->sensor,
                      options.magnetic_sigma, &evidence_);
  }
  Solution solution = SolutionOf(pass);
  if (survey) {
    JudgeMagneticClock(pass.magnetometer, MagnetometerOf(dataset_)->sensor,
                       imu_, UsualTiltSigma(solution), &evidence_);
  }
  return solution;
}

std::vector<SurveyedField> AttitudeEstimation::FieldReadings(
    const std::vector<Eigen::Quaterniond>& q_nb,
    const MagnetometerErrors& errors) const {
  constexpr double kSpacing = 0.1;  // [s]
  std::vector<SurveyedField> readings;
  std::size_t k = 0;
  for (const MagneticSample& sample : magnetic_) {
    const double t = sample.t + errors.time_offset;
    if (t < imu_.t_begin() || t > imu_.t_end()) continue;
    const double dt = readings.empty() ? kSpacing : t - readings.back().t;
    if (dt < kSpacing) continue;
    while (k + 2 < imu_.samples.size() && imu_.samples[k + 1].t <= t) ++k;
    const double part =
        (t - imu_.samples[k].t) / (imu_.samples[k + 1].t - imu_.samples[k].t);
    SurveyedField reading;
    reading.t = t;
    reading.q_nb = q_nb[k].slerp(part, q_nb[k + 1]);
    reading.field_b = sample.field_b - errors.hard_iron_b;
    reading.dt = dt;
    reading.at_rest = rests_[k];
    reading.w_b = imu_.samples[k].gyro;
    readings.push_back(reading);
  }
  return readings;
}

namespace {

void TakeOff(std::span<const AttachedMagnet> magnets,
             std::span<SurveyedField> readings) {
  for (SurveyedField& reading : readings) {
    for (const AttachedMagnet& magnet : magnets) {
      if (reading.t < magnet.begin || reading.t > magnet.end) continue;
      reading.field_b -= magnet.field_b;
    }
  }
}

}  // namespace

AttitudeEstimation::Pass AttitudeEstimation::SmoothSurveyed(
    std::span<const BiasedForce> forces,
    const std::vector<Eigen::Quaterniond>& level,
    AttitudeFilterOptions options) const {
  SurveyOptions survey_options = {
      .sigma = options.magnetic_sigma,
      .correlation_time = options.magnetic_correlation_time,
      .reject = dataset_.ahrs.reject_disturbances};
  options.reference.enabled = false;
  options.dip_sigma = kUnknownDipSigma;
  options.magnetic_correlation_time = 0.0;
  const auto smooth = [&](const std::vector<Eigen::Quaterniond>& q_nb,
                          const MagnetometerErrors& errors, bool covariances) {
    std::vector<SurveyedField> readings = FieldReadings(q_nb, errors);
    survey_options.weak_iron = errors.weak_iron;
    FieldSurvey survey = SurveyField(readings, survey_options);
    std::vector<AttachedMagnet> magnets;
    if (survey_options.heading_known && survey_options.reject) {
      magnets = FindAttachedMagnets(readings, survey, survey_options.sigma);
      if (!magnets.empty()) {
        TakeOff(magnets, readings);
        survey_options.weak_iron = FindMagnetometerErrors(readings).weak_iron;
        survey = SurveyField(readings, survey_options);
      }
    }
    if (!headings_.empty()) survey.turn = 0.0;  // north is measured
    options.magnetic.horizontal = survey.horizontal;
    options.magnetic.down = survey.down;
    options.magnetic.declination =
        filter_options_.magnetic.declination + RestAzimuth(survey);
    std::vector<MagneticSample> weighed;
    weighed.reserve(readings.size());
    for (std::size_t k = 0; k < readings.size(); ++k) {
      weighed.push_back({readings[k].t, readings[k].field_b, survey.weight[k]});
    }
    AttitudeState start = start_;
    const double turn = options.magnetic.declination - survey.azimuth;
    start.q_nb = Exp(Eigen::Vector3d(0.0, 0.0, turn)) * q_nb.front();
    Pass pass =
        Smooth(start, forces, weighed, options, "ahrs_smoother", covariances);
    pass.survey = std::move(survey);
    pass.magnetometer = errors;
    pass.magnets = std::move(magnets);
    return pass;
  };
  const auto attitudes = [this](const Pass& pass) {
    return AttitudesAtSamples(pass.run, pass.smoothed, imu_);
  };
  std::vector<Eigen::Quaterniond> q_nb =
      attitudes(smooth(level, {}, /*covariances=*/false));
  const MagnetometerErrors errors = FindMagnetometerErrors(
      FieldReadings(q_nb, {}),
      MagnetometerOf(dataset_)->sensor.time_offset_sigma.value_or(0.0));
  if (!errors.hard_iron_b.isZero(0.0) || errors.time_offset != 0.0) {
    q_nb = attitudes(smooth(level, errors, /*covariances=*/false));
  }
  survey_options.heading_known = true;
  return smooth(q_nb, errors, /*covariances=*/true);
}

}  // namespace hindsight
