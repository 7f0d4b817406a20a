#include "simulation/scenario.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/error.h"
#include "dataset/injection.h"

namespace hindsight {
namespace {

/// Random stream of the initial errors, clear of those in sensor_errors.cc.
constexpr std::uint64_t kStartStream = 100;

void RequirePositive(const Scenario& scenario, double value,
                     const char* quantity) {
  if (value > 0.0 && std::isfinite(value)) return;
  throw InputError("scenario '" + scenario.name + "': the " + quantity +
                   " is not positive");
}

/// Of the rows that a rate makes of `span`; those of truth and aiding are held
/// in memory.
void RequireModest(const Scenario& scenario, double span, double rate_hz,
                   double most, const char* rows) {
  if (span * rate_hz <= most) return;
  throw InputError("scenario '" + scenario.name +
                   fmt::format("': makes {:.3g} {}; expected at most {:.0f}",
                               span * rate_hz, rows, most));
}

/// Checks that the scenario is not too long.
double EndOf(const Scenario& scenario, const Trajectory& trajectory) {
  constexpr double kMostSamples = 200e6;
  constexpr double kMostRows = 10e6;
  const double span =
      std::min(trajectory.t_end() - trajectory.t_begin(), scenario.duration);
  if (span > kLongestScenario) {
    throw InputError("scenario '" + scenario.name +
                     fmt::format("': lasts {:.6g} s; expected at most {:.0f}",
                                 span, kLongestScenario));
  }
  RequireModest(scenario, span, scenario.imu_rate_hz, kMostSamples,
                "IMU samples");
  RequireModest(scenario, span,
                std::min(scenario.truth_rate_hz, scenario.imu_rate_hz),
                kMostRows, "rows of truth");
  for (const AidingModel& model : scenario.aiding) {
    RequireModest(scenario, span, model.rate_hz, kMostRows,
                  "measurements of a sensor");
  }
  return trajectory.t_begin() + span;
}

std::size_t TruthEvery(const Scenario& scenario) {
  const double samples = scenario.imu_rate_hz / scenario.truth_rate_hz;
  return static_cast<std::size_t>(std::max(1L, std::lround(samples)));
}

TruthPoint TruthAt(const Motion& motion, const ImuErrors& errors) {
  const Eigen::Matrix3d C_ne = NedAxes(motion.p_e).transpose();
  TruthPoint point;
  point.t = motion.t;
  point.p_e = motion.p_e;
  point.v_n = C_ne * motion.v_e;
  point.q_nb = (Eigen::Quaterniond(C_ne) * motion.q_eb).normalized();
  point.b_g = errors.gyro_bias();
  point.b_a = errors.accel_bias();
  return point;
}

/// What the user is told of a start bias: how large it may be, whether drawn or
/// fixed.
std::optional<Eigen::Vector3d> BiasSigma(const Eigen::Vector3d& bias,
                                         const Eigen::Vector3d& sigma) {
  const Eigen::Vector3d total =
      (bias.cwiseAbs2() + sigma.cwiseAbs2()).cwiseSqrt();
  if (total.minCoeff() > 0.0) return total;
  return std::nullopt;
}

InitialState DrawInitialState(const Scenario& scenario, const Motion& start,
                              std::uint64_t seed) {
  InitialState initial;
  initial.gyro_bias_sigma =
      BiasSigma(scenario.imu.gyro_bias, scenario.imu.gyro_bias_sigma);
  initial.accel_bias_sigma =
      BiasSigma(scenario.imu.accel_bias, scenario.imu.accel_bias_sigma);
  if (!scenario.start_errors) return initial;
  const StartErrors& sigma = *scenario.start_errors;
  Random random(seed, kStartStream);
  const Eigen::Vector3d d_position =
      sigma.position.cwiseProduct(random.NormalVector3());
  const Eigen::Vector3d d_velocity =
      sigma.velocity.cwiseProduct(random.NormalVector3());
  const Eigen::Vector3d d_attitude =
      sigma.attitude.cwiseProduct(random.NormalVector3());
  const Eigen::Matrix3d C_en = NedAxes(start.p_e);
  State truth;
  truth.p_e = start.p_e;
  truth.v_e = start.v_e;
  truth.q_eb = start.q_eb;
  initial.t = start.t;
  initial.position = GeodeticFromEcef(start.p_e + C_en * d_position);
  initial.position_sigma = sigma.position;
  if (sigma.position_alone) return initial;
  initial.v_n = truth.v_n() + d_velocity;
  initial.euler = truth.euler() + d_attitude;
  initial.velocity_sigma = sigma.velocity;
  initial.attitude_sigma = sigma.attitude;
  return initial;
}

/// The data set but for IMU samples and truth.
Dataset MakeDataset(const Scenario& scenario, PerfectAiding perfect,
                    const Motion& start, std::uint64_t seed) {
  Dataset dataset;
  dataset.name = scenario.name;
  dataset.imu.kind = scenario.imu_kind;
  dataset.imu.noise = scenario.imu.noise;
  dataset.imu.max_gap =
      std::max(dataset.imu.max_gap, 1.5 / scenario.imu_rate_hz);
  for (std::size_t k = 0; k < scenario.aiding.size(); ++k) {
    std::vector<Measurement>& measurements = perfect.measurements[k];
    AddMeasurementErrors(scenario.aiding[k], seed, perfect.q_nb[k],
                         &measurements);
    DrawnSensor drawn = DrawSensor(scenario.aiding[k], seed);
    dataset.streams.push_back(
        {std::move(drawn.sensor), MeasurementSeries(measurements)});
    dataset.true_constants.merge(drawn.true_constants);
    for (const TimeSpan& silence : scenario.aiding[k].outages) {
      dataset.silences.push_back(
          {static_cast<int>(k), silence.begin, silence.end});
    }
  }
  dataset.initial = DrawInitialState(scenario, start, seed);
  if (!scenario.imu.accel_scale_sigma.isZero(0.0)) {
    dataset.accel_scale_sigma = scenario.imu.accel_scale_sigma;
  }
  dataset.stationary = scenario.stationary;
  dataset.max_node_spacing = scenario.max_node_spacing;
  dataset.withholdings = scenario.withholdings;
  ApplyWithholding(&dataset);
  ApplyInjections(scenario.injections, seed, &dataset);
  return dataset;
}

/// What follows from the truth: what the data set says of the IMU's scale
/// factors and what they are, and the start.
void AddFromTruth(const Scenario& scenario, const ImuErrors& errors,
                  std::uint64_t seed, Dataset* dataset) {
  const ImuErrorModel& model = scenario.imu;
  const auto add = [&](const char* name, const Eigen::Vector3d& sigma,
                       const Eigen::Vector3d& truth,
                       std::optional<Eigen::Vector3d>* prior) {
    if (sigma.isZero(0.0)) return;
    *prior = sigma;
    static const char* const kAxes[] = {"[x]", "[y]", "[z]"};
    for (int i = 0; i < 3; ++i) {
      dataset->true_constants[std::string(name) + kAxes[i]] = truth(i);
    }
  };
  add("gyro_scale", model.gyro_scale_sigma, errors.gyro_scale(),
      &dataset->gyro_scale_sigma);
  add("accel_scale", model.accel_scale_sigma, errors.accel_scale(),
      &dataset->accel_scale_sigma);
  if (scenario.start_errors && scenario.start_errors->bad_attitude) {
    GiveBadStart(*scenario.start_errors->bad_attitude, seed, dataset);
  }
}

PerfectAiding AllPerfectMeasurements(const Scenario& scenario,
                                     Trajectory* trajectory, double t_end) {
  PerfectAiding all;
  for (const AidingModel& model : scenario.aiding) {
    RequirePositive(scenario, model.rate_hz, "rate of an aiding sensor");
    const auto sensor = static_cast<int>(all.measurements.size());
    all.measurements.push_back(PerfectMeasurements(
        model, sensor, trajectory, t_end, &all.q_nb.emplace_back()));
  }
  return all;
}

}  // namespace

std::unique_ptr<Trajectory> MakeTrajectory(const Scenario& scenario) {
  RequirePositive(scenario, scenario.imu_rate_hz, "rate of the IMU");
  constexpr double kFastestImu = 20000.0;
  if (scenario.imu_rate_hz > kFastestImu) {
    throw InputError("scenario '" + scenario.name +
                     "': the IMU rate is above 20 kHz");
  }
  RequirePositive(scenario, scenario.truth_rate_hz, "rate of the truth");
  if (!scenario.profile.empty()) {
    return std::make_unique<SampledTrajectory>(scenario.profile);
  }
  if (scenario.hand.duration > 0.0) {
    return std::make_unique<HandTrajectory>(
        scenario.start, scenario.start_heading, scenario.hand);
  }
  if (!scenario.way_points.points.empty()) {
    constexpr double kStep = 0.5;  // [s]
    return std::make_unique<SampledTrajectory>(
        WayPointPath(scenario.way_points).Profile(scenario.start, kStep));
  }
  return std::make_unique<SegmentTrajectory>(
      scenario.start,
      MotionProfile(scenario.segments, scenario.start_speed,
                    scenario.start_heading),
      scenario.imu_rate_hz);
}

Simulation::Simulation(const Scenario& scenario, std::uint64_t seed)
    : scenario_(scenario),
      seed_(seed),
      trajectory_(MakeTrajectory(scenario)),
      t_end_(EndOf(scenario, *trajectory_)),
      imu_(trajectory_.get(), scenario.imu_kind, scenario.imu_rate_hz, t_end_),
      errors_(scenario.imu, scenario.imu_kind, scenario.imu_rate_hz, seed),
      truth_every_(TruthEvery(scenario)) {}

bool Simulation::Next(ImuSample* sample) {
  if (!imu_.Next(sample)) return false;
  errors_.Apply(sample);
  if (index_++ % truth_every_ == 0) {
    truth_.push_back(TruthAt(imu_.motion(), errors_));
  }
  return true;
}

Dataset Simulation::Finish() {
  Dataset dataset = MakeDataset(
      scenario_, AllPerfectMeasurements(scenario_, trajectory_.get(), t_end_),
      trajectory_->At(trajectory_->t_begin()), seed_);
  dataset.truth = std::move(truth_);
  AddFromTruth(scenario_, errors_, seed_, &dataset);
  return dataset;
}

Dataset Simulate(const Scenario& scenario, std::uint64_t seed) {
  Simulation simulation(scenario, seed);
  PagedVector<ImuSample> samples(simulation.sample_count());
  for (ImuSample& sample : samples) simulation.Next(&sample);
  Dataset dataset = simulation.Finish();
  dataset.imu.samples = std::move(samples);
  return dataset;
}

PerfectRecording::PerfectRecording(const Scenario& scenario)
    : scenario_(scenario), truth_every_(TruthEvery(scenario)) {
  const std::unique_ptr<Trajectory> trajectory = MakeTrajectory(scenario);
  const double t_end = EndOf(scenario, *trajectory);
  ImuSimulator imu(trajectory.get(), scenario.imu_kind, scenario.imu_rate_hz,
                   t_end);
  samples_.resize(imu.size());
  for (std::size_t k = 0; k < samples_.size(); ++k) {
    imu.Next(&samples_[k]);
    if (k % truth_every_ == 0) truth_.push_back(imu.motion());
  }
  aiding_ = AllPerfectMeasurements(scenario, trajectory.get(), t_end);
}

Dataset PerfectRecording::Realize(std::uint64_t seed) const {
  Dataset dataset = MakeDataset(scenario_, aiding_, truth_.front(), seed);
  ImuErrors errors(scenario_.imu, scenario_.imu_kind, scenario_.imu_rate_hz,
                   seed);
  dataset.imu.samples = samples_;
  for (std::size_t k = 0; k < samples_.size(); ++k) {
    errors.Apply(&dataset.imu.samples[k]);
    if (k % truth_every_ == 0) {
      dataset.truth.push_back(TruthAt(truth_[k / truth_every_], errors));
    }
  }
  AddFromTruth(scenario_, errors, seed, &dataset);
  return dataset;
}

Dataset PerfectRecording::WithoutErrors(Dataset dataset) const {
  dataset.imu.samples = samples_;
  for (std::size_t i = 0; i < dataset.streams.size(); ++i) {
    MeasurementSeries& series = dataset.streams[i].measurements;
    if (series.size() != aiding_.measurements[i].size()) continue;
    auto perfect = aiding_.measurements[i].begin();
    for (Measurement& z : series.Edited()) z.model = (perfect++)->model;
  }
  return dataset;
}

}  // namespace hindsight
