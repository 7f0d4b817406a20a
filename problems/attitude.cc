#include "problems/attitude.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/processor_time.h"
#include "base/units.h"
#include "dataset/repeated_readings.h"
#include "evaluation/grade.h"
#include "filters/rts.h"
#include "geometry/so3.h"
#include "problems/method.h"
#include "problems/tilt_batch.h"

namespace hindsight {
namespace {

/// The samples of [from, to], increments as mean rates.
ImuStream RatesWithin(const ImuStream& imu, double from, double to) {
  ImuStream out = imu;
  out.kind = ImuStream::Kind::kRates;
  out.samples.clear();
  for (std::size_t k = 0; k < imu.samples.size(); ++k) {
    ImuSample sample = imu.samples[k];
    if (sample.t < from || sample.t > to) continue;
    if (imu.kind == ImuStream::Kind::kIncrements) {
      const std::size_t j = std::max<std::size_t>(k, 1);
      const double dt = imu.samples[j].t - imu.samples[j - 1].t;
      // The mean over the interval is the rate at its middle.
      sample.t -= 0.5 * dt;
      sample.gyro /= dt;
      sample.accel /= dt;
    }
    out.samples.push_back(sample);
  }
  if (out.empty()) throw InputError("no IMU data in the asked interval");
  return out;
}

}  // namespace

AttitudeEstimation::AttitudeEstimation(const Dataset& dataset,
                                       AttitudeOptions options)
    : dataset_(dataset),
      options_(std::move(options)),
      imu_(RatesWithin(dataset.imu, options_.from, options_.to)),
      magnetic_(MagneticSamples(dataset)),
      filter_options_(FilterOptionsOf(dataset)) {
  std::erase_if(magnetic_, [this](const MagneticSample& sample) {
    return sample.t < imu_.t_begin() || sample.t > imu_.t_end();
  });
  start_ = StartOfAttitude(dataset, imu_, magnetic_);
}

void AttitudeEstimation::Poll(const std::string& stage, double fraction) const {
  if (options_.stop != nullptr && *options_.stop) throw Interrupted();
  if (options_.progress) options_.progress(stage, fraction);
}

namespace {

Eigen::Quaterniond NedAttitude(const State& x) {
  return Eigen::Quaterniond(Eigen::Matrix3d(x.C_en().transpose())) * x.q_eb;
}

void FillVerdicts(const AttitudeRun& run, Solution* solution) {
  solution->accel_sigma.reserve(run.epochs.size());
  solution->magnetic.reserve(run.epochs.size());
  for (const AttitudeEpoch& epoch : run.epochs) {
    const AttitudeVerdict& verdict = epoch.verdict;
    solution->accel_sigma.push_back(std::sqrt(verdict.accel_variance));
    solution->magnetic.push_back(static_cast<signed char>(
        verdict.magnetic_used ? 1 : (verdict.magnetic_disturbed ? -1 : 0)));
  }
}

}  // namespace

Solution AttitudeEstimation::Filter() {
  const AttitudeRun run = RunAttitudeFilter(
      imu_, magnetic_, filter_options_, start_, nullptr, [&](std::size_t k) {
        Poll("ahrs",
             static_cast<double>(k) / static_cast<double>(imu_.samples.size()));
      });
  Solution solution;
  solution.layout = AttitudeLayout(imu_.noise, start_);
  solution.covariances = CovarianceSeries(6, run.epochs.size());
  solution.states.reserve(run.epochs.size());
  const Eigen::Quaterniond q_en(NedAxes(filter_options_.place.p_e));
  for (std::size_t k = 0; k < run.epochs.size(); ++k) {
    const AttitudeState& a = run.epochs[k].x;
    State x;
    x.t = a.t;
    x.p_e = filter_options_.place.p_e;
    x.q_eb = (q_en * a.q_nb).normalized();
    x.b_g = a.b_g;
    solution.states.push_back(x);
    solution.covariances.Set(k, a.P);
  }
  FillVerdicts(run, &solution);
  return solution;
}

Solution AttitudeEstimation::Smooth(const ImuStream& imu,
                                    std::span<const MagneticSample> magnetic,
                                    const AttitudeFilterOptions& options,
                                    const std::string& stage) const {
  AttitudeState start = start_;
  if (!readings_.empty()) start.q_nb = NedAttitude(level_->states.front());
  LinearTape tape(AttitudeLayout(imu_.noise, start));
  const AttitudeRun run = RunAttitudeFilter(
      imu, magnetic, options, start, &tape, [&](std::size_t k) {
        Poll(stage,
             static_cast<double>(k) / static_cast<double>(imu_.samples.size()));
      });
  Solution nodes;
  nodes.layout = tape.layout();
  SmoothedTrajectory smoothed = SmoothRts(std::move(tape));
  nodes.states = std::move(smoothed.states);
  nodes.covariances = std::move(smoothed.P);
  Solution solution = NodesAtSamples(nodes, imu_, nodes.layout);
  FillVerdicts(run, &solution);
  return solution;
}

/// Runs once: gravity and the gyros alone.
void AttitudeEstimation::Level() {
  if (!level_) level_ = Smooth(imu_, {}, filter_options_, "survey");
}

/// Runs once; turns the levelled solution to the field it finds.
void AttitudeEstimation::Survey() {
  if (!readings_.empty()) return;
  Level();
  std::vector<double> times;
  std::vector<const MagneticSample*> chosen;
  for (const MagneticSample& sample : magnetic_) {
    if (!times.empty() && sample.t < times.back() + kRoomNodeSpacing) continue;
    times.push_back(sample.t);
    chosen.push_back(&sample);
  }
  if (times.empty()) return;
  const Solution at = SampleAttitude(*level_, imu_, times);
  for (std::size_t k = 0; k < times.size(); ++k) {
    SurveyedField reading{times[k], NedAttitude(at.states[k]),
                          chosen[k]->field_b};
    const std::size_t before = k > 0 ? k - 1 : 0;
    const double angle =
        at.states[before].q_eb.angularDistance(at.states[k].q_eb);
    const double dt = k > 0 ? times[k] - times[before] : kRoomNodeSpacing;
    reading.weight = IndependentPart(dt, angle);
    readings_.push_back(reading);
  }
  survey_ = SurveyField(readings_);
  const double turn = filter_options_.magnetic.declination -
                      std::atan2(survey_.field_n.y(), survey_.field_n.x());
  const Eigen::Matrix3d C_en = NedAxes(filter_options_.place.p_e);
  const Eigen::Quaterniond q_turn = Exp(C_en * Eigen::Vector3d(0.0, 0.0, turn));
  for (State& x : level_->states) x.q_eb = q_turn * x.q_eb;
}

/// What comes after a sample averages the acceleration too, in the axes that
/// the levelled solution keeps still.
ImuStream AttitudeEstimation::WithAveragedForce() const {
  std::vector<Eigen::Quaterniond> q_nb;
  q_nb.reserve(level_->states.size());
  for (const State& x : level_->states) q_nb.push_back(NedAttitude(x));
  const std::vector<Eigen::Vector3d> f_n = AveragedForce(imu_, q_nb);
  ImuStream averaged = imu_;
  for (std::size_t k = 0; k < f_n.size(); ++k) {
    averaged.samples[k].accel = q_nb[k].conjugate() * f_n[k];
  }
  return averaged;
}

Solution AttitudeEstimation::Smoother() {
  AttitudeFilterOptions options = filter_options_;
  ImuStream imu = imu_;
  if (!dataset_.ahrs.low_pass && options.low_pass_tau > 0.0) {
    Level();
    imu = WithAveragedForce();
    options.low_pass_tau = 0.0;
  }
  if (magnetic_.empty() || !dataset_.ahrs.survey) {
    return Smooth(imu, magnetic_, options, "ahrs_smoother");
  }
  Survey();
  options.reference.enabled = false;
  options.magnetic.horizontal = survey_.field_n.head<2>().norm();
  options.magnetic.down = survey_.field_n.z();
  options.magnetic_sigma = kFieldScale;
  options.magnetic_correlation_time = 0.0;
  std::vector<MagneticSample> weighed;
  for (std::size_t k = 0; k < readings_.size(); ++k) {
    weighed.push_back(
        {readings_[k].t, readings_[k].field_b - survey_.hard_iron_b,
         survey_.IsDisturbed(k) ? 0.0
                                : readings_[k].weight * survey_.trust[k]});
  }
  return Smooth(imu, weighed, options, "ahrs_smoother");
}

RoomProblem AttitudeEstimation::SurveyedProblem() {
  Survey();
  return {dataset_, imu_, readings_, survey_, *level_, filter_options_.place};
}

Solution AttitudeEstimation::RoomBatch() {
  return WithReadings(SolveRoomBatch(SurveyedProblem(), [&](double fraction) {
    Poll("ahrs_batch", fraction);
  }));
}

Solution AttitudeEstimation::TiltBatch() {
  return WithReadings(SolveTiltBatch(SurveyedProblem(), [&](double fraction) {
    Poll("ahrs_tilt_batch", fraction);
  }));
}

/// Says of each state what became of the reading of the field there.
Solution AttitudeEstimation::WithReadings(Solution solution) const {
  solution.magnetic.assign(solution.states.size(), 0);
  std::size_t i = 0;
  for (std::size_t k = 0; k < readings_.size(); ++k) {
    while (i + 1 < solution.states.size() &&
           solution.states[i].t < readings_[k].t) {
      ++i;
    }
    solution.magnetic[i] =
        static_cast<signed char>(survey_.IsDisturbed(k) ? -1 : 1);
  }
  return solution;
}

Solution AttitudeEstimation::Run(const std::string& name) {
  const Method& method = MethodOf(name);
  if (!method.attitude_alone()) {
    throw InputError("method '" + name + "' does not estimate attitude alone");
  }
  const double t0 = ProcessorSeconds();
  Solution solution = method.estimate_attitude(this);
  solution.method = method.name;
  solution.seconds = ProcessorSeconds() - t0;
  Conclude({.solution = solution,
            .recording =
                FindRepeatedReadings(dataset_, imu_.t_begin(), imu_.t_end()),
            .relative_heading = magnetic_.empty()},
           {}, &solution);
  if (imu_.stamp_offset != 0.0) {
    std::vector<double> stamps;
    for (const ImuSample& sample : imu_.samples) {
      const double t = sample.t - imu_.stamp_offset;
      if (t >= imu_.t_begin()) stamps.push_back(t);
    }
    solution = SampleAttitude(solution, imu_, stamps);
  }
  return solution;
}

}  // namespace hindsight
