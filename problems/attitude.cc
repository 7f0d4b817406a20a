#include "problems/attitude.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/processor_time.h"
#include "dataset/repeated_readings.h"
#include "dataset/rest.h"
#include "evaluation/grade.h"
#include "filters/rts.h"
#include "geometry/so3.h"
#include "imu/mean_reading.h"

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
      imu_(RatesWithin(dataset.imu, options_.from, options_.to)),
      magnetic_(MagneticSamples(dataset)),
      filter_options_(FilterOptionsOf(dataset)) {
  std::erase_if(magnetic_, [this](const MagneticSample& sample) {
    return sample.t < imu_.t_begin() || sample.t > imu_.t_end();
  });
  start_ = StartOfAttitude(dataset, imu_, magnetic_);
}

ErrorLayout AttitudeEstimation::SolutionLayout() const {
  const ErrorLayout full = AttitudeLayout(imu_.noise, start_);
  ErrorLayout layout;
  for (const Block& block : full.blocks()) {
    if (block.key.kind != BlockKind::kGyroScale) layout.Add(block);
  }
  return layout;
}

void AttitudeEstimation::Poll(const std::string& stage, double fraction) const {
  if (options_.stop != nullptr && *options_.stop) throw Interrupted();
  if (options_.progress) options_.progress(stage, fraction);
}

namespace {

Eigen::Quaterniond NedAttitude(const State& x) {
  return Eigen::Quaterniond(Eigen::Matrix3d(x.C_en().transpose())) * x.q_eb;
}

AttitudePart VerdictsOf(const AttitudeRun& run) {
  AttitudePart part;
  part.accel_sigma.reserve(run.epochs.size());
  part.magnetic.reserve(run.epochs.size());
  for (const AttitudeEpoch& epoch : run.epochs) {
    const AttitudeVerdict& verdict = epoch.verdict;
    part.accel_sigma.push_back(std::sqrt(verdict.accel_variance));
    part.magnetic.push_back(static_cast<signed char>(
        verdict.magnetic_used ? 1 : (verdict.magnetic_disturbed ? -1 : 0)));
  }
  return part;
}

}  // namespace

Solution AttitudeEstimation::Filter() {
  const AttitudeRun run = RunAttitudeFilter(
      imu_, magnetic_, filter_options_, start_, nullptr, [&](std::size_t k) {
        Poll("ahrs",
             static_cast<double>(k) / static_cast<double>(imu_.samples.size()));
      });
  Solution solution;
  solution.layout = SolutionLayout();
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
    solution.covariances.Set(k, a.P.topLeftCorner<6, 6>());
  }
  solution.attitude = VerdictsOf(run);
  if (dataset_.stationary.enabled) {
    solution.notes.emplace_back(
        "no use for 'stationary': what knows nothing later finds rest by "
        "thresholds of its own");
  }
  return solution;
}

namespace {

std::vector<ConstantEstimate> GyroScales(const Solution& nodes) {
  const Block& block = *nodes.layout.Find(BlockKind::kGyroScale);
  const ErrorMatrix P = nodes.covariances.Get(0);
  std::vector<ConstantEstimate> scales;
  for (int axis = 0; axis < 3; ++axis) {
    ConstantEstimate scale;
    scale.name = std::string("gyro_scale[") + "xyz"[axis] + "]";
    scale.unit = block.unit;
    scale.value = nodes.states.front().parameters(axis);
    scale.sigma = std::sqrt(P(block.offset + axis, block.offset + axis));
    scale.prior_sigma = block.sigma0(axis);
    constexpr double kTold = 0.9;
    scale.verdict = scale.sigma < kTold * scale.prior_sigma
                        ? ConstantEstimate::Verdict::kObserved
                        : ConstantEstimate::Verdict::kUnobserved;
    scales.push_back(scale);
  }
  return scales;
}

}  // namespace

Solution AttitudeEstimation::Smooth(const AttitudeState& start,
                                    const ImuStream& imu,
                                    std::span<const MagneticSample> magnetic,
                                    const AttitudeFilterOptions& options,
                                    const std::string& stage) const {
  LinearTape tape(AttitudeLayout(imu_.noise, start_));
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
  Solution solution = NodesAtSamples(nodes, imu_, SolutionLayout());
  solution.constants = GyroScales(nodes);
  solution.attitude = VerdictsOf(run);
  return solution;
}

std::vector<bool> AttitudeEstimation::FindRests() const {
  std::vector<bool> rests(imu_.samples.size(), false);
  if (filter_options_.rest_sigma <= 0.0) return rests;
  Dataset still;
  still.imu = imu_;
  still.stationary = dataset_.stationary;
  still.initial = dataset_.initial;
  const Rest rest = FindRest(still);
  const Eigen::Vector3d sigma = start_.P.diagonal().segment<3>(3).cwiseSqrt();
  constexpr double kSigmas = 3.0;
  for (const auto* spans : {&rest.at_rest, &rest.moving, &rest.undecided}) {
    for (const TimeInterval& span : *spans) {
      const Eigen::Vector3d rate =
          MeanReading(imu_, span.begin, span.end).w_ib_b - start_.b_g;
      // FindRest looks for quiet readings, and those of a steady turn are as
      // quiet as at rest: their mean must be a rate that the bias explains.
      if ((rate.cwiseAbs().array() > kSigmas * sigma.array()).any()) continue;
      // A motion that begins or ends slowly is quiet at first, too: the rest is
      // taken to be shorter by a window on either side.
      const double margin = dataset_.stationary.window;
      for (std::size_t k = 0; k + 1 < rests.size(); ++k) {
        const double from = imu_.samples[k].t;
        const double to = imu_.samples[k + 1].t;
        if ((from >= span.begin + margin || span.begin <= imu_.t_begin()) &&
            from >= span.begin &&
            (to <= span.end - margin || span.end >= imu_.t_end()) &&
            to <= span.end) {
          rests[k] = true;
        }
      }
    }
  }
  return rests;
}

namespace {

/// Specific forces averaged over what comes before and after each sample
/// (AveragedForce), in the NED axes by the attitudes of `level`: a smoother may
/// use what comes later.
ImuStream WithAveragedForce(const ImuStream& imu, const Solution& level,
                            double tau) {
  std::vector<Eigen::Quaterniond> q_nb;
  q_nb.reserve(level.states.size());
  for (const State& x : level.states) q_nb.push_back(NedAttitude(x));
  const std::vector<Eigen::Vector3d> f_n = AveragedForce(imu, q_nb, tau);
  ImuStream averaged = imu;
  for (std::size_t k = 0; k < f_n.size(); ++k) {
    averaged.samples[k].accel = q_nb[k].conjugate() * f_n[k];
  }
  return averaged;
}

}  // namespace

Solution AttitudeEstimation::Smoother() {
  AttitudeFilterOptions options = filter_options_;
  if (rests_.empty()) rests_ = FindRests();
  options.rests = rests_;
  const bool average = !dataset_.ahrs.low_pass && options.low_pass_tau > 0.0;
  const bool survey = dataset_.ahrs.survey && !magnetic_.empty();
  if (!average && !survey) {
    return Smooth(start_, imu_, magnetic_, options, "ahrs_smoother");
  }
  const Solution level = Smooth(start_, imu_, {}, options, "survey");
  ImuStream imu = imu_;
  if (average) {
    imu = WithAveragedForce(imu_, level, options.low_pass_tau);
    options.low_pass_tau = 0.0;
  }
  return survey ? SmoothSurveyed(imu, level, options)
                : Smooth(start_, imu, magnetic_, options, "ahrs_smoother");
}

std::vector<SurveyedField> AttitudeEstimation::FieldReadings(
    const Solution& attitudes, const Eigen::Vector3d& hard_iron_b) const {
  constexpr double kSpacing = 0.1;  // [s]
  std::vector<double> times;
  std::vector<SurveyedField> readings;
  for (const MagneticSample& sample : magnetic_) {
    const double dt = times.empty() ? kSpacing : sample.t - times.back();
    if (dt < kSpacing) continue;
    SurveyedField reading;
    reading.t = sample.t;
    reading.field_b = sample.field_b - hard_iron_b;
    reading.dt = dt;
    times.push_back(sample.t);
    readings.push_back(reading);
  }
  const Solution at = SampleAttitude(attitudes, imu_, times);
  std::size_t k = 0;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    while (k + 1 < imu_.samples.size() &&
           imu_.samples[k + 1].t <= readings[i].t) {
      ++k;
    }
    readings[i].q_nb = NedAttitude(at.states[i]);
    readings[i].at_rest = rests_[k];
  }
  return readings;
}

Solution AttitudeEstimation::SmoothSurveyed(
    const ImuStream& imu, const Solution& level,
    AttitudeFilterOptions options) const {
  SurveyOptions survey_options = {
      .sigma = options.magnetic_sigma,
      .correlation_time = options.magnetic_correlation_time,
      .reject = dataset_.ahrs.reject_disturbances};
  options.reference.enabled = false;
  options.magnetic_correlation_time = 0.0;
  const auto smooth = [&](const Solution& attitudes,
                          const Eigen::Vector3d& hard_iron_b) {
    const std::vector<SurveyedField> readings =
        FieldReadings(attitudes, hard_iron_b);
    const FieldSurvey survey = SurveyField(readings, survey_options);
    options.magnetic.horizontal = survey.horizontal;
    options.magnetic.down = survey.down;
    std::vector<MagneticSample> weighed;
    for (std::size_t k = 0; k < readings.size(); ++k) {
      weighed.push_back({readings[k].t, readings[k].field_b, survey.weight[k]});
    }
    AttitudeState start = start_;
    const double turn = options.magnetic.declination - survey.azimuth;
    start.q_nb = Exp(Eigen::Vector3d(0.0, 0.0, turn)) *
                 NedAttitude(attitudes.states.front());
    return Smooth(start, imu, weighed, options, "ahrs_smoother");
  };
  Solution solution = smooth(level, Eigen::Vector3d::Zero());
  const Eigen::Vector3d hard_iron_b =
      FindHardIron(FieldReadings(solution, Eigen::Vector3d::Zero()));
  if (!hard_iron_b.isZero(0.0)) solution = smooth(level, hard_iron_b);
  survey_options.heading_known = true;
  return smooth(solution, hard_iron_b);
}

Solution AttitudeEstimation::Sample(const Solution& solution,
                                    const std::vector<double>& times) const {
  return SampleAttitude(solution, dataset_.imu, times);
}

Solution AttitudeEstimation::Run(const Method& method) {
  const double t0 = ProcessorSeconds();
  Solution solution = std::get<Method::OfAttitude>(method.run)(this);
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
