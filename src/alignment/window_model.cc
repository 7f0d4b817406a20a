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
      layout_(BuildLayout(dataset_, BiasPrior())),
      timeline_(BuildTimeline(
          dataset_,
          {.t_begin = input.t,
           .t_end = t_end,
           .extra_times = {},
           .time_offsets = {},
           .with_scale_jacobians = layout_.Has(BlockKind::kGyroScale) ||
                                   layout_.Has(BlockKind::kAccelScale)})),
      all_(timeline_.all_measurements().size(), 1) {}

SmoothedTrajectory WindowModel::FilterFrom(const WindowStart& start) {
  return SmoothRts(
      RunExtendedKalmanFilter(layout_, NearPrior(start), &timeline_, all_));
}

IteratedResult WindowModel::Settle(const State& near, std::vector<State> states,
                                   const CovarianceSeries& rough) {
  IterationOptions options;
  options.max_iterations = kMaxIterations;
  options.rough = &rough;
  return SmoothIterated(layout_, VaguePrior(near), std::move(states),
                        &timeline_, all_, options);
}

SmoothedTrajectory WindowModel::Smooth(const State& near,
                                       const std::vector<State>& states) {
  const Prior prior = VaguePrior(near);
  SmoothedTrajectory smoothed =
      SmoothRts(RunLinearizedFilter(layout_, prior, states, &timeline_, all_));
  WidenHeading(layout_,
               CreditHeading(layout_, prior, smoothed.states, smoothed.P,
                             &timeline_, all_),
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
  ErrorMatrix P = layout_.InitialCovariance();
  SetSigmas(layout_, BlockKind::kPosition, position, &P);
  SetSigmas(layout_, BlockKind::kVelocity, velocity, &P);
  SetSigmas(layout_, BlockKind::kAttitude, kUnknownHeadingSigma, &P);
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
  x.parameters = InitialParameters(dataset_, layout_);
  constexpr double kNearPosition = 30.0;
  constexpr double kNearVelocity = 3.0;
  ErrorMatrix P = Covariance(kNearPosition, kNearVelocity);
  const int a = layout_.Find(BlockKind::kAttitude)->offset;
  P.block<3, 3>(a, a) =
      9.0 * start.P + Eigen::Matrix3d::Identity() * kDegree * kDegree;
  return {x, P};
}

Prior WindowModel::VaguePrior(const State& near) const {
  State x = near;
  const InitialState& given = dataset_.initial;
  x.b_g = given.gyro_bias;
  x.b_a = given.accel_bias;
  x.parameters = InitialParameters(dataset_, layout_);
  ErrorMatrix P = Covariance(kVaguePosition, kVagueVelocity);
  if (given.position) {
    x.p_e = EcefFromGeodetic(*given.position);
    P.topLeftCorner<3, 3>() =
        given.position_sigma.value_or(Eigen::Vector3d::Ones())
            .cwiseAbs2()
            .asDiagonal();
  }
  if (known_) {
    const int a = layout_.Find(BlockKind::kAttitude)->offset;
    x.q_eb = known_->q_eb;
    P.block<3, 3>(a, a) = known_->P;
  }
  return {x, P};
}

double WindowModel::Nis(const std::vector<State>& states) const {
  LinearizedMeasurement z;
  double sum = 0.0;
  double rows = 0.0;
  for (std::size_t k = 0; k < timeline_.size(); ++k) {
    for (const Measurement& measurement : timeline_.measurements(k)) {
      Evaluate(measurement,
               timeline_.Context(k, measurement, layout_, states[k]), &z);
      sum += z.residual.dot(Eigen::LLT<RowMatrix>(z.R).solve(z.residual));
      rows += static_cast<double>(z.residual.size());
    }
  }
  return rows > 0.0 ? sum / rows : 1.0;
}

}  // namespace hindsight
