#include "alignment/window_smoother.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "alignment/start_layout.h"
#include "base/error.h"
#include "dataset/timeline_builder.h"
#include "filters/heading_profile.h"
#include "filters/iterated_smoother.h"

namespace hindsight {
namespace {

constexpr double kVagueVelocity = 100.0;   // [m/s]
constexpr double kVaguePosition = 1000.0;  // [m]
constexpr int kMaxIterations = 40;
/// Gyro bias walks of a warm-up: 0.1 are 0.8 deg/s in a minute [rad/s/sqrt(s)].
constexpr std::array<double, 5> kDriftingWalks = {
    0.003 * kDegree, 0.01 * kDegree, 0.03 * kDegree, 0.1 * kDegree,
    0.3 * kDegree};
constexpr double kNotably = 5.0;  // odds of 150 to 1
/// Of WarmUpWalk: beyond five a priori sigmas in a minute a misfit is no drift.
constexpr double kFastestDrift = 5.0;

/// Measurements that need no calibration found elsewhere first.
bool IsPlain(const MeasurementModel& model) {
  return std::holds_alternative<PositionFix>(model) ||
         std::holds_alternative<VelocityFix>(model) ||
         std::holds_alternative<HeightFix>(model) ||
         std::holds_alternative<SpeedCourse>(model) ||
         std::holds_alternative<ZeroVelocity>(model) ||
         std::holds_alternative<ZeroAngularRate>(model);
}

/// What the window holds of a recording, samples included.
Dataset CutOut(const AlignmentInput& input, double t_end) {
  const Dataset& whole = input.dataset;
  const double t_begin = input.t;
  Dataset cut;
  cut.imu = ImuStream{whole.imu.kind,
                      {},
                      whole.imu.noise,
                      whole.imu.max_gap,
                      whole.imu.nominal_dt};
  const auto before = [](const ImuSample& sample, double t) {
    return sample.t < t;
  };
  const auto& samples = whole.imu.samples;
  auto first =
      std::lower_bound(samples.begin(), samples.end(), t_begin, before);
  auto last = std::lower_bound(first, samples.end(), t_end, before);
  first -= std::min<std::ptrdiff_t>(2, first - samples.begin());
  last += std::min<std::ptrdiff_t>(2, samples.end() - last);
  cut.imu.samples.assign(first, last);
  cut.gyro_scale_sigma = whole.gyro_scale_sigma;
  cut.accel_scale_sigma = whole.accel_scale_sigma;
  cut.max_node_spacing = whole.max_node_spacing;
  cut.initial = whole.initial;
  const GyroBiasPrior gyro = GyroBiasBefore(input);
  cut.initial.gyro_bias = gyro.b_g;
  cut.initial.gyro_bias_sigma = gyro.sigma;
  for (const AidingStream& stream : whole.streams) {
    AidingStream& kept = cut.streams.emplace_back();
    kept.sensor = stream.sensor;
    for (const Measurement& z : stream.measurements) {
      const double t = z.t + stream.sensor.time_offset;
      if (t >= t_begin && t <= t_end && !z.withheld && IsPlain(z.model)) {
        kept.measurements.push_back(z);
      }
    }
    if (!kept.measurements.empty()) continue;
    // Without measurements it needs no states.
    kept.sensor = Sensor();
    kept.sensor.name = stream.sensor.name;
  }
  return cut;
}

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

class WindowSmoother {
 public:
  /// The largest of the stated gyro bias walk and `least_walk` is used.
  WindowSmoother(const AlignmentInput& input, double t_end,
                 const WindowStart& start,
                 const std::optional<AttitudePrior>& known, double least_walk)
      : input_(input),
        start_(start),
        known_(known),
        dataset_(WithWalk(CutOut(input, t_end), least_walk)),
        layout_(BuildLayout(dataset_, BiasPrior())),
        timeline_(BuildTimeline(
            dataset_,
            {.t_begin = input.t,
             .t_end = t_end,
             .extra_times = {},
             .time_offsets = {},
             .with_scale_jacobians = layout_.Has(BlockKind::kGyroScale) ||
                                     layout_.Has(BlockKind::kAccelScale)})) {}

  std::optional<WindowSolution> Solve() {
    const GateDecisions all(timeline_.all_measurements().size(), 1);
    SmoothedTrajectory rts = SmoothRts(
        RunExtendedKalmanFilter(layout_, NearPrior(), &timeline_, all));
    IterationOptions options;
    options.max_iterations = kMaxIterations;
    const Prior prior = VaguePrior(rts.states.front());
    IteratedResult result = SmoothIterated(
        layout_, prior, std::move(rts.states), &timeline_, all, options);
    if (!result.converged) return std::nullopt;
    WindowSolution out;
    out.layout = layout_;
    out.gyro_bias_walk = dataset_.imu.noise.gyro_bias_walk;
    out.log_likelihood = LogLikelihood(prior, result.trajectory.states, all);
    out.nis = Nis(result.trajectory.states);
    const double scale = std::max(1.0, out.nis);
    out.P = CovarianceSeries(layout_.dim(), result.trajectory.P.size());
    for (std::size_t k = 0; k < out.P.size(); ++k) {
      out.P.Set(k, ErrorMatrix(scale * result.trajectory.P.Get(k)));
    }
    out.states = std::move(result.trajectory.states);
    WidenHeading(
        layout_,
        HeadingCurvature(layout_, prior, out.states, out.P, &timeline_, all),
        &out.P);
    return out;
  }

 private:
  NavigationPrior BiasPrior() const {
    NavigationPrior prior;
    prior.gyro_bias_sigma = GyroBiasSigma(dataset_.initial);
    prior.accel_bias_sigma = AccelBiasSigma(dataset_.initial);
    prior.gyro_bias = dataset_.imu.noise.GyroBiasEvolution();
    prior.accel_bias = dataset_.imu.noise.AccelBiasEvolution();
    return prior;
  }

  ErrorMatrix Covariance(double position, double velocity) const {
    ErrorMatrix P = layout_.InitialCovariance();
    SetSigmas(layout_, BlockKind::kPosition, position, &P);
    SetSigmas(layout_, BlockKind::kVelocity, velocity, &P);
    SetSigmas(layout_, BlockKind::kAttitude, kUnknownHeadingSigma, &P);
    return P;
  }

  /// Near enough to be filtered from: the attitude three times as uncertain as
  /// the coarse alignment says, and a degree.
  Prior NearPrior() const {
    State x;
    x.t = input_.t;
    x.p_e = input_.p_e;
    x.v_e = x.C_en() * FirstVelocity(input_);
    x.q_eb = start_.q_eb;
    x.b_g = start_.b_g;
    x.b_a = start_.b_a;
    x.parameters = InitialParameters(dataset_, layout_);
    constexpr double kNearPosition = 30.0;
    constexpr double kNearVelocity = 3.0;
    ErrorMatrix P = Covariance(kNearPosition, kNearVelocity);
    const int a = layout_.Find(BlockKind::kAttitude)->offset;
    P.block<3, 3>(a, a) =
        9.0 * start_.P + Eigen::Matrix3d::Identity() * kDegree * kDegree;
    return {x, P};
  }

  /// Says nothing of velocity and, unless they are given, attitude and
  /// position.
  Prior VaguePrior(const State& near) const {
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

  double LogLikelihood(const Prior& prior, const std::vector<State>& states,
                       const GateDecisions& all) {
    const LinearTape tape =
        RunLinearizedFilter(layout_, prior, states, &timeline_, all);
    double sum = 0.0;
    for (std::size_t k = 0; k < tape.size(); ++k) {
      for (const TapeMeasurement& z : tape.measurements(k)) {
        sum += z.log_likelihood;
      }
    }
    return sum;
  }

  double Nis(const std::vector<State>& states) const {
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

  const AlignmentInput& input_;
  const WindowStart& start_;
  const std::optional<AttitudePrior>& known_;
  Dataset dataset_;
  ErrorLayout layout_;
  Timeline timeline_;
};

std::optional<WindowSolution> SmoothWithWalk(
    const AlignmentInput& input, double t_end, const WindowStart& start,
    const std::optional<AttitudePrior>& known, double least_walk) {
  try {
    return WindowSmoother(input, t_end, start, known, least_walk).Solve();
  } catch (const EstimationError&) {
    return std::nullopt;  // diverged
  }
}

/// What is lost or gained in log-likelihood before one walk counts as better.
double Notably(const WindowSolution& solution) {
  return kNotably * std::max(1.0, solution.nis);
}

/// `likeliest` with the largest walk, up to `most`, that the window does not
/// refute.
template <typename Smooth>
WindowSolution WithLargestWalk(WindowSolution likeliest, double most,
                               const Smooth& smooth) {
  std::vector<double> walks(kDriftingWalks.rbegin(), kDriftingWalks.rend());
  std::erase_if(walks, [&](double walk) { return walk >= most; });
  walks.insert(walks.begin(), most);
  for (const double walk : walks) {
    if (walk <= likeliest.gyro_bias_walk) break;
    std::optional<WindowSolution> found = smooth(walk);
    if (found &&
        found->log_likelihood > likeliest.log_likelihood - Notably(likeliest)) {
      return *std::move(found);
    }
  }
  return likeliest;
}

}  // namespace

double WarmUpWalk(const AlignmentInput& input) {
  constexpr double kMinute = 60.0;
  return GyroBiasSigma(input.dataset.initial).maxCoeff() / std::sqrt(kMinute);
}

std::optional<WindowSolution> SmoothWindow(
    const AlignmentInput& input, double t_end, const WindowStart& start,
    const std::optional<AttitudePrior>& known) {
  const double usual =
      std::max(input.dataset.imu.noise.gyro_bias_walk, input.least_gyro_walk);
  const auto smooth = [&](double walk) {
    return SmoothWithWalk(input, t_end, start, known, walk);
  };
  std::optional<WindowSolution> best = smooth(usual);
  for (const double walk : kDriftingWalks) {
    if (walk < 2.0 * usual) continue;
    if (walk > kFastestDrift * WarmUpWalk(input)) break;
    auto found = smooth(walk);
    if (!found) continue;
    if (best) {
      const double gain = found->log_likelihood - best->log_likelihood;
      if (gain < 0.0) break;
      if (gain < Notably(*found)) continue;
    }
    best = std::move(found);
  }
  if (!best || best->gyro_bias_walk <= usual) return best;
  return WithLargestWalk(*std::move(best), WarmUpWalk(input), smooth);
}

}  // namespace hindsight
