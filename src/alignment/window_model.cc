#include "alignment/window_model.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "alignment/start_layout.h"
#include "dataset/timeline_builder.h"
#include "filters/heading_profile.h"
#include "filters/iterated_smoother.h"

namespace hindsight {
namespace {

constexpr double kVagueVelocity = 100.0;   // [m/s]
constexpr double kVaguePosition = 1000.0;  // [m]
constexpr int kMaxIterations = 40;

/// Velocity at input.t as the earliest measurements have it.
Eigen::Vector3d FirstVelocity(const AlignmentInput& input) {
  if (input.rest || input.velocities.empty()) return Eigen::Vector3d::Zero();
  return std::min_element(input.velocities.begin(), input.velocities.end(),
                          [&](const TimedVelocity& a, const TimedVelocity& b) {
                            return std::abs(a.t - input.t) <
                                   std::abs(b.t - input.t);
                          })
      ->v_n;
}

/// Sets the blocks of the navigation state of a covariance.
void SetSigmas(const ErrorLayout& layout, BlockKind kind, double sigma,
               ErrorMatrix* P) {
  const int offset = layout.Find(kind)->offset;
  P->block<3, 3>(offset, offset) = Eigen::Matrix3d::Identity() * sigma * sigma;
}

Dataset WithWalk(Dataset dataset, double least_walk) {
  ImuNoise& noise = dataset.imu.noise;
  if (least_walk > noise.gyro_bias_walk) {
    noise.gyro_bias_walk = least_walk;
    noise.gyro_bias_tau = std::numeric_limits<double>::infinity();
  }
  return dataset;
}

}  // namespace

WindowModel::WindowModel(const AlignmentInput& input, double t_end,
                         const std::optional<AttitudePrior>& known,
                         const Dataset& data, double least_walk)
    : input_(input),
      known_(known),
      dataset_(WithWalk(data, least_walk)),
      problem_(MakeProblem(t_end)) {}

Problem WindowModel::MakeProblem(double t_end) const {
  const ErrorLayout layout = BuildLayout(dataset_, BiasPrior());
  const bool with_scale =
      layout.Has(BlockKind::kGyroScale) || layout.Has(BlockKind::kAccelScale);
  Problem problem = {
      layout,
      {},
      BuildTimeline(dataset_, {.t_begin = input_.t,
                               .t_end = t_end,
                               .extra_times = {},
                               .time_offsets = {},
                               .with_scale_jacobians = with_scale})};
  problem.decisions.assign(problem.timeline.all_measurements().size(), 1);
  return problem;
}

SmoothedTrajectory WindowModel::FilterFrom(const WindowStart& start) {
  problem_.prior = NearPrior(start);
  return SmoothRts(RunExtendedKalmanFilter(&problem_));
}

IteratedResult WindowModel::Settle(const State& near, std::vector<State> states,
                                   const CovarianceSeries& rough) {
  IterationOptions options;
  options.max_iterations = kMaxIterations;
  options.rough = &rough;
  problem_.prior = VaguePrior(near);
  return SmoothIterated(std::move(states), options, &problem_);
}

SmoothedTrajectory WindowModel::Smooth(const State& near,
                                       const std::vector<State>& states) {
  problem_.prior = VaguePrior(near);
  SmoothedTrajectory smoothed =
      SmoothRts(RunLinearizedFilter(states, &problem_));
  WidenHeading(problem_.layout,
               CreditHeading(problem_, smoothed.states, smoothed.P),
               &smoothed.P);
  return smoothed;
}

NavigationPrior WindowModel::BiasPrior() const {
  NavigationPrior prior;
  prior.gyro_bias_sigma = GyroBiasSigma(dataset_.initial);
  prior.accel_bias_sigma = AccelBiasSigma(dataset_.initial);
  prior.gyro_bias = dataset_.imu.noise.GyroBiasEvolution();
  prior.accel_bias = dataset_.imu.noise.AccelBiasEvolution();
  return prior;
}

ErrorMatrix WindowModel::Covariance(double position, double velocity) const {
  ErrorMatrix P = InitialCovariance(dataset_, problem_.layout);
  SetSigmas(problem_.layout, BlockKind::kPosition, position, &P);
  SetSigmas(problem_.layout, BlockKind::kVelocity, velocity, &P);
  SetSigmas(problem_.layout, BlockKind::kAttitude, kUnknownHeadingSigma, &P);
  return P;
}

Prior WindowModel::NearPrior(const WindowStart& start) const {
  State x;
  x.t = input_.t;
  x.p_e = input_.p_e;
  x.v_e = x.C_en() * FirstVelocity(input_);
  x.q_eb = start.q_eb;
  x.b_g = start.b_g;
  x.b_a = start.b_a;
  x.parameters = InitialParameters(dataset_, problem_.layout);
  constexpr double kNearPosition = 30.0;
  constexpr double kNearVelocity = 3.0;
  ErrorMatrix P = Covariance(kNearPosition, kNearVelocity);
  const int a = problem_.layout.Find(BlockKind::kAttitude)->offset;
  P.block<3, 3>(a, a) =
      9.0 * start.P + Eigen::Matrix3d::Identity() * kDegree * kDegree;
  return {x, P};
}

Prior WindowModel::VaguePrior(const State& near) const {
  State x = near;
  const InitialState& given = dataset_.initial;
  x.b_g = given.gyro_bias;
  x.b_a = given.accel_bias;
  x.parameters = InitialParameters(dataset_, problem_.layout);
  ErrorMatrix P = Covariance(kVaguePosition, kVagueVelocity);
  if (given.position) {
    x.p_e = EcefFromGeodetic(*given.position);
    P.topLeftCorner<3, 3>() =
        given.position_sigma.value_or(Eigen::Vector3d::Ones())
            .cwiseAbs2()
            .asDiagonal();
  }
  if (known_) {
    const int a = problem_.layout.Find(BlockKind::kAttitude)->offset;
    x.q_eb = known_->q_eb;
    P.block<3, 3>(a, a) = known_->P;
  }
  return {x, P};
}

double WindowModel::Nis(const std::vector<State>& states) const {
  LinearizedMeasurement z;
  double sum = 0.0;
  double rows = 0.0;
  for (std::size_t k = 0; k < problem_.timeline.size(); ++k) {
    for (const Measurement& measurement : problem_.timeline.measurements(k)) {
      Evaluate(
          measurement,
          problem_.timeline.Context(k, measurement, problem_.layout, states[k]),
          &z);
      sum += z.residual.dot(Eigen::LLT<RowMatrix>(z.R).solve(z.residual));
      rows += static_cast<double>(z.residual.size());
    }
  }
  return rows > 0.0 ? sum / rows : 1.0;
}

}  // namespace hindsight
