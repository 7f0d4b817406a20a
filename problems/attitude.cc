#include "problems/attitude.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "alignment/given.h"
#include "alignment/magnetic_heading.h"
#include "base/error.h"
#include "base/processor_time.h"
#include "earth/wgs84.h"
#include "evaluation/grade.h"
#include "evaluation/observability.h"
#include "geometry/so3.h"
#include "measurements/sensor_kind.h"
#include "problems/attitude_evidence.h"
#include "problems/shared_covariance.h"

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
                                       ReconstructionOptions options)
    : dataset_(dataset),
      options_(std::move(options)),
      imu_(RatesWithin(
          dataset.imu,
          GivenStartTime(dataset,
                         std::max(options_.from, dataset.imu.t_begin()),
                         std::min(options_.to, dataset.imu.t_end())),
          options_.to)),
      magnetic_(MagneticSamples(dataset)),
      headings_(HeadingSamples(dataset)),
      velocities_(VelocitySamples(dataset)),
      filter_options_(FilterOptionsOf(dataset)),
      q_en_(NedAxes(filter_options_.place.p_e)) {
  const auto outside = [this](const auto& sample) {
    return sample.t < imu_.t_begin() || sample.t > imu_.t_end();
  };
  std::erase_if(magnetic_, outside);
  std::erase_if(headings_, outside);
  std::erase_if(velocities_, outside);
  force_ratio_ = MedianForce(imu_) / filter_options_.place.gravity;
  if (IsOtherUnit(force_ratio_) && force_ratio_ > 0.0) {
    for (ImuSample& sample : imu_.samples) sample.accel /= force_ratio_;
  }
  std::optional<AlignedAttitude> found;
  if (magnetic_.empty()) {
    found = AttitudeByVelocity(dataset, imu_, options_.to);
  }
  const AlignedAttitude* start = found ? &*found : nullptr;
  if (!HeadingIsTold(dataset, start)) velocities_.clear();
  start_ = StartOfAttitude(dataset, imu_, magnetic_, start);
}

ErrorLayout AttitudeEstimation::SolutionLayout() const {
  const ErrorLayout full = AttitudeLayout(imu_.noise, start_);
  ErrorLayout layout;
  for (const Block& block : full.blocks()) {
    if (block.key.kind == BlockKind::kAttitude ||
        block.key.kind == BlockKind::kGyroBias) {
      layout.Add(block);
    }
  }
  return layout;
}

void AttitudeEstimation::Poll(const std::string& stage, double fraction) const {
  if (options_.stop != nullptr && *options_.stop) throw Interrupted();
  if (options_.progress) options_.progress(stage, fraction);
}

namespace {

AttitudePart VerdictsOf(const AttitudeRun& run) {
  AttitudePart part;
  part.accel_sigma.reserve(run.samples.size());
  part.magnetic.reserve(run.samples.size());
  for (const AttitudeSample& sample : run.samples) {
    const AttitudeVerdict& verdict = run.nodes[sample.node].verdict;
    part.accel_sigma.push_back(std::sqrt(verdict.accel_variance));
    part.magnetic.push_back(static_cast<signed char>(
        verdict.magnetic_used ? 1 : (verdict.magnetic_disturbed ? -1 : 0)));
  }
  return part;
}

}  // namespace

State AttitudeEstimation::StateAt(double t, const Eigen::Quaterniond& q_nb,
                                  const Eigen::Vector3d& b_g) const {
  State x;
  x.t = t;
  x.p_e = filter_options_.place.p_e;
  x.q_eb = (q_en_ * q_nb).normalized();
  x.b_g = b_g;
  return x;
}

double AttitudeEstimation::SharedSigma(const FieldSurvey& survey) const {
  if (magnetic_.empty() || !headings_.empty()) return 0.0;
  const MagneticSurroundings& stated = filter_options_.magnetic;
  const bool seen = survey.horizontal > 0.0 && filter_options_.magnetic_form ==
                                                   MagneticField::Form::kVector;
  return std::hypot(SharedHeadingSigma(stated), NorthSigma(survey),
                    seen ? PlaceSigma(survey, stated) : 0.0);
}

double AttitudeEstimation::SharedSlope(const FieldSurvey& survey) const {
  if (magnetic_.empty() || !headings_.empty() ||
      filter_options_.magnetic_form == MagneticField::Form::kVector ||
      !filter_options_.decouple_heading) {
    return 0.0;
  }
  if (survey.horizontal > 0.0) return survey.down / survey.horizontal;
  const MagneticSurroundings& stated = filter_options_.magnetic;
  return stated.horizontal > 0.0 ? stated.down / stated.horizontal : 0.0;
}

Solution AttitudeEstimation::Filter() {
  const AttitudeRun run = RunAttitudeFilter(
      imu_, {magnetic_, headings_, velocities_}, filter_options_, start_,
      /*to_be_smoothed=*/false, [&](std::size_t k) {
        Poll("ahrs",
             static_cast<double>(k) / static_cast<double>(imu_.samples.size()));
      });
  Solution solution;
  solution.layout = SolutionLayout();
  solution.covariances = CovarianceSeries(6, run.samples.size());
  solution.states.reserve(run.samples.size());
  const SharedCovariance shared(filter_options_, 0.0);
  std::size_t node = run.nodes.size();
  double shared_sigma = 0.0;
  Eigen::Matrix<double, 6, 6> P;
  for (std::size_t k = 0; k < run.samples.size(); ++k) {
    const AttitudeSample& sample = run.samples[k];
    solution.states.push_back(
        StateAt(imu_.samples[k].t, sample.q_nb, sample.b_g));
    if (sample.node != node) {
      node = sample.node;
      const AttitudeVerdict& verdict = run.nodes[node].verdict;
      FieldSurvey learned;
      learned.horizontal = verdict.horizontal;
      learned.down = verdict.down;
      shared_sigma = SharedSigma(learned);
    }
    P = run.nodes[node].x.P.topLeftCorner<6, 6>();
    shared.AddTo(shared_sigma, &P);
    solution.covariances.Set(k, P);
  }
  solution.attitude = VerdictsOf(run);
  innovations_ = InnovationsOf(run);
  solution.notes = UnusedByFilter();
  return solution;
}

namespace {

ConstantEstimate TimeOffsetOf(const Sensor& sensor,
                              const MagnetometerErrors& found) {
  ConstantEstimate offset;
  offset.name = sensor.name + "_time_offset";
  offset.unit = "s";
  offset.prior_value = sensor.time_offset;
  offset.value = sensor.time_offset + found.time_offset;
  offset.sigma = found.time_offset_sigma;
  offset.prior_sigma = *sensor.time_offset_sigma;
  offset.verdict = VerdictOfSigma(offset.sigma, offset.prior_sigma);
  return offset;
}

/// Of a block of three, which begins at row `begin` of P.
void AddConstants(const Block& block, const Eigen::Vector3d& prior,
                  const Eigen::Vector3d& value, const AttitudeState::Matrix& P,
                  int begin, std::vector<ConstantEstimate>* constants) {
  for (int axis = 0; axis < 3; ++axis) {
    ConstantEstimate one;
    one.name = block.name + "[" + "xyz"[axis] + "]";
    one.unit = block.unit;
    one.prior_value = prior(axis);
    one.value = value(axis);
    one.sigma = std::sqrt(P(begin + axis, begin + axis));
    one.prior_sigma = block.sigma0(axis);
    one.verdict = VerdictOfSigma(one.sigma, one.prior_sigma);
    constants->push_back(one);
  }
}

}  // namespace

Solution AttitudeEstimation::SolutionOf(const Pass& pass) {
  Solution solution;
  solution.layout = SolutionLayout();
  const std::size_t count = pass.run.samples.size();
  const std::vector<Eigen::Quaterniond> q_nb =
      AttitudesAtSamples(pass.run, pass.smoothed, imu_);
  solution.covariances = CovarianceSeries(6, count);
  solution.states.reserve(count);
  const auto& nodes = pass.run.nodes;
  const double shared_sigma = SharedSigma(pass.survey);
  const SharedCovariance shared(filter_options_, SharedSlope(pass.survey));
  Eigen::Matrix<double, 6, 6> P;
  for (std::size_t k = 0; k < count; ++k) {
    const AttitudeSample& sample = pass.run.samples[k];
    const double t = imu_.samples[k].t;
    std::size_t nearest = sample.node;
    if (nearest + 1 < nodes.size() &&
        nodes[nearest + 1].x.t - t < t - nodes[nearest].x.t) {
      ++nearest;
    }
    solution.states.push_back(StateAt(
        t, q_nb[k], sample.b_g + pass.smoothed[sample.node].d.segment<3>(3)));
    P = pass.smoothed[nearest].P.topLeftCorner<6, 6>();
    shared.AddTo(shared_sigma, &P);
    solution.covariances.Set(k, P);
  }
  const ErrorLayout full = AttitudeLayout(imu_.noise, start_);
  const AttitudeState first = StateOf(pass.run, pass.smoothed, 0);
  AddConstants(*full.Find(BlockKind::kGyroScale), start_.s_g, first.s_g,
               first.P, AttitudeState::kGyroScale, &solution.constants);
  AddConstants(*full.Find(BlockKind::kAccelBias), start_.b_a, first.b_a,
               first.P, AttitudeState::kAccelBias, &solution.constants);
  if (pass.magnetometer.time_offset_sigma > 0.0) {
    solution.constants.push_back(
        TimeOffsetOf(MagnetometerOf(dataset_)->sensor, pass.magnetometer));
  }
  for (const AttachedMagnet& magnet : pass.magnets) {
    solution.notes.push_back(fmt::format(
        "a magnet of {:.0f} uT that travels along from {:.1f} to {:.1f} s",
        magnet.field_b.norm(), magnet.begin, magnet.end));
  }
  solution.attitude = VerdictsOf(pass.run);
  innovations_ = InnovationsOf(pass.run);
  return solution;
}

Solution AttitudeEstimation::Sample(const Solution& solution,
                                    const std::vector<double>& times) const {
  return SampleAttitude(solution, imu_, times);
}

Solution AttitudeEstimation::Run(const Method& method) {
  const double t0 = ProcessorSeconds();
  evidence_.clear();
  innovations_.clear();
  Solution solution = std::get<Method::OfAttitude>(method.run)(this);
  solution.method = method.name;
  solution.seconds = ProcessorSeconds() - t0;
  for (std::string& note : Unused()) solution.notes.push_back(std::move(note));
  const std::vector<Sensor> sources = JudgedSources();
  const std::vector<InnovationFigure> figures =
      TestInnovations(innovations_, kFalseAlarms);
  std::optional<StartValues> start;
  // With a field the smoother turns its start to the north that it surveys.
  if (magnetic_.empty()) {
    start =
        StartOf(solution.layout, start_.P,
                StateAt(start_.t, start_.q_nb, start_.b_g), dataset_.initial);
  }
  bool vouched_for = false;
  if (method.Has(MethodTrait::kForward)) {
    vouched_for = JudgeFilterByAll(start, sources, solution);
  } else {
    JudgeWhole(solution);
  }
  Conclude({.solution = solution,
            .sensors = sources,
            .start = start,
            .innovations = figures,
            .vouched_for = vouched_for,
            .recording = ExamineRecording(),
            .relative_heading =
                magnetic_.empty() && headings_.empty() && velocities_.empty(),
            .mounting_sigma = dataset_.mounting_sigma},
           {}, &solution);
  if (auto apart = methods_.Compare(solution)) {
    AddEvidence(*std::move(apart), &solution);
  }
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
