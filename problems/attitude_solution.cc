#include <fmt/core.h>

#include <cmath>

#include "alignment/magnetic_heading.h"
#include "evaluation/observability.h"
#include "measurements/sensor_kind.h"
#include "problems/attitude.h"
#include "problems/attitude_evidence.h"

/// \file
/// How runs of the attitude filter become solutions.

namespace hindsight {
namespace {

/// Covariance of an attitude with what P leaves out: an error of heading [rad]
/// that all attitudes share, and, where the heading was taken from the field as
/// if the tilt were known, the turn by which the tilt's error levels the field,
///   psi_D += slope (cos(declination) psi_N + sin(declination) psi_E),
/// `slope` = down / horizontal; 0: the tilt's error was counted.
class SharedCovariance {
 public:
  SharedCovariance(const AttitudeFilterOptions& options, double slope) {
    const double declination = options.magnetic.declination;
    turn_.row(2).head<2>() << slope * std::cos(declination),
        slope * std::sin(declination);
  }
  /// P of attitude and gyro bias; the sigma of what headings share [rad].
  void AddTo(double heading_sigma, Eigen::Matrix<double, 6, 6>* P) const {
    P->topRows<3>() = (turn_ * P->topRows<3>()).eval();
    P->leftCols<3>() = (P->leftCols<3>() * turn_.transpose()).eval();
    (*P)(2, 2) += heading_sigma * heading_sigma;
  }

 private:
  Eigen::Matrix3d turn_ = Eigen::Matrix3d::Identity();
};

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
      FieldSurvey learned;
      learned.horizontal = run.nodes[node].verdict.horizontal;
      learned.down = run.nodes[node].verdict.down;
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
  if (pass.survey.horizontal > 0.0) {
    solution.notes.push_back(
        fmt::format("a field of {:.1f} uT horizontal and {:.1f} uT down",
                    pass.survey.horizontal, pass.survey.down));
  }
  solution.attitude = VerdictsOf(pass.run);
  innovations_ = InnovationsOf(pass.run);
  return solution;
}

}  // namespace hindsight
