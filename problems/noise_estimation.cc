#include "problems/noise_estimation.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "alignment/start.h"
#include "base/error.h"
#include "dataset/timeline_builder.h"

namespace hindsight {
namespace {

constexpr int kSweeps = 12;
constexpr double kSettled = 0.02;       // change of ln(factor) in a sweep
constexpr double kSettledSigmas = 0.1;  // the same, in its standard deviations
constexpr double kFirstStep = 0.7;      // a factor of two
constexpr double kLeastStep = 0.1;
constexpr double kLargestMove = 2.0;  // in steps
constexpr double kFarthest = 7.0;     // a factor of a thousand
/// What less a gain of the likelihood shows nothing.
constexpr double kLeastGain = 1e-3;

/// One number of a data set's noise: multiplies it.
struct NoiseQuantity {
  std::string name;
  std::function<void(double factor)> scale;
};

/// A Gauss-Markov error of a stream, as the configuration says it.
struct ErrorProcess {
  int sensor;
  BlockKind kind;
  const double* sigma;
  const double* tau;
};

/// The likelihood of a data set as a function of the logarithms of its noise
/// factors.
class Likelihood {
 public:
  explicit Likelihood(const Dataset& dataset) : dataset_(dataset) {
    for (std::size_t i = 0; i < dataset_.streams.size(); ++i) {
      AidingStream& stream = dataset_.streams[i];
      stream.sensor.gate_probability.reset();
      stream.sensor.loss = RobustLoss();
      // A prior is no noise that the data could tell.
      if (stream.sensor.type == SensorType::kVehicleLevel) continue;
      AddStream(static_cast<int>(i), &stream);
    }
    ImuNoise& imu = dataset_.imu.noise;
    Add("imu.gyro", &imu.gyro_noise_density);
    Add("imu.accel", &imu.accel_noise_density);
    applied_.assign(quantities_.size(), 0.0);
    start_ = FindStart(dataset_, -std::numeric_limits<double>::infinity(),
                       std::numeric_limits<double>::infinity());
  }
  Likelihood(const Likelihood&) = delete;
  Likelihood& operator=(const Likelihood&) = delete;

  std::size_t size() const { return quantities_.size(); }
  const std::string& name(std::size_t i) const { return quantities_[i].name; }

  double operator()(const std::vector<double>& logs) {
    for (std::size_t i = 0; i < logs.size(); ++i) {
      if (logs[i] != applied_[i]) {
        quantities_[i].scale(std::exp(logs[i] - applied_[i]));
      }
    }
    applied_ = logs;
    TimelineOptions options;
    options.t_begin = start_.report.t;
    options.t_end = dataset_.imu.t_end();
    Timeline timeline = BuildTimeline(dataset_, options);
    Prior prior = start_.prior;
    prior.x.t = timeline.node(0).t;
    const ErrorLayout layout = PresentLayout(&prior);
    try {
      const LinearTape tape = RunExtendedKalmanFilter(layout, prior, &timeline);
      double sum = 0.0;
      for (std::size_t k = 0; k < tape.size(); ++k) {
        for (const TapeMeasurement& z : tape.measurements(k)) {
          if (z.accepted) sum += z.log_likelihood;
        }
      }
      return sum;
    } catch (const EstimationError&) {
      return -std::numeric_limits<double>::infinity();
    }
  }

 private:
  void Add(const std::string& name, double* value) {
    quantities_.push_back({name, [value](double f) { *value *= f; }});
  }

  void AddProcess(const std::string& name, const ErrorProcess& process,
                  double* sigma, double* tau) {
    processes_.push_back(process);
    Add(name, sigma);
    Add(name + "_tau", tau);
  }

  void AddStream(int index, AidingStream* stream) {
    Sensor& sensor = stream->sensor;
    if (sensor.noise.kind == NoiseModel::Kind::kGaussMarkov) {
      NoiseModel& noise = sensor.noise;
      Add(sensor.name + ".white", &noise.white_sigma);
      const BlockKind kind = sensor.type == SensorType::kHeight
                                 ? BlockKind::kOffset
                                 : BlockKind::kColouredNoise;
      AddProcess(sensor.name + ".gauss_markov",
                 {index, kind, &noise.sigma, &noise.tau}, &noise.sigma,
                 &noise.tau);
      return;
    }
    quantities_.push_back({sensor.name, [stream](double factor) {
                             for (Measurement& z : stream->measurements) {
                               ScaleSigma(factor, &z);
                             }
                           }});
    MagneticSurroundings& magnetic = sensor.magnetic;
    if (!magnetic.disturbance_sigma) return;
    AddProcess(sensor.name + ".disturbance",
               {index, BlockKind::kDisturbance, &*magnetic.disturbance_sigma,
                &magnetic.disturbance_tau},
               &*magnetic.disturbance_sigma, &magnetic.disturbance_tau);
  }

  /// The layout with the processes as they are now, and the prior to it.
  ErrorLayout PresentLayout(Prior* prior) const {
    ErrorLayout layout;
    for (Block block : start_.layout.blocks()) {
      for (const ErrorProcess& process : processes_) {
        if (block.key.kind != process.kind ||
            block.key.sensor != process.sensor) {
          continue;
        }
        block.evolution = Evolution::GaussMarkov(*process.sigma, *process.tau);
        block.sigma0.setConstant(*process.sigma);
        prior->P.diagonal()
            .segment(block.offset, block.dim)
            .setConstant(*process.sigma * *process.sigma);
      }
      layout.Add(block);
    }
    return layout;
  }

  Dataset dataset_;
  Start start_;
  std::vector<NoiseQuantity> quantities_;
  std::vector<ErrorProcess> processes_;
  std::vector<double> applied_;
};

struct Coordinate {
  double step = kFirstStep;
  double moved = 0.0;
  double sigma = std::numeric_limits<double>::infinity();

  bool IsSettled() const {
    return std::abs(moved) < std::max(kSettled, std::isfinite(sigma)
                                                    ? kSettledSigmas * sigma
                                                    : kSettled);
  }
};

/// Moves along one coordinate to the vertex of the parabola through three
/// points a step apart, or to the best point tried. Returns its likelihood.
double Climb(Likelihood* likelihood, std::size_t i, double value,
             std::vector<double>* logs, Coordinate* coordinate) {
  const double centre = (*logs)[i];
  double best = centre;
  double best_value = value;
  const auto at = [&](double move) {
    std::vector<double> moved = *logs;
    moved[i] = std::clamp(centre + move, -kFarthest, kFarthest);
    const double tried = (*likelihood)(moved);
    if (tried > best_value + kLeastGain) {
      best_value = tried;
      best = moved[i];
    }
    return tried;
  };
  const double step = coordinate->step;
  const double plus = at(step);
  const double minus = at(-step);
  const double curvature = (2.0 * value - plus - minus) / (step * step);
  const double limit = kLargestMove * step;
  if (std::isfinite(curvature) && curvature > 0.0) {
    const double vertex = (plus - minus) / (2.0 * step) / curvature;
    at(std::clamp(vertex, -limit, limit));
  }
  coordinate->sigma = curvature > 1.0 / (kFarthest * kFarthest)
                          ? 1.0 / std::sqrt(curvature)
                          : std::numeric_limits<double>::infinity();
  coordinate->moved = best - centre;
  const double distance = std::abs(best - centre);
  coordinate->step = std::clamp(distance < limit ? distance : 2.0 * step,
                                kLeastStep, kFarthest);
  (*logs)[i] = best;
  return best_value;
}

/// The sum of a sweep's moves once more, as long as it gains: coordinates that
/// make up for each other would take many sweeps.
double Extrapolate(Likelihood* likelihood,
                   const std::vector<Coordinate>& coordinates, double value,
                   std::vector<double>* logs) {
  for (;;) {
    std::vector<double> moved = *logs;
    for (std::size_t i = 0; i < moved.size(); ++i) {
      moved[i] =
          std::clamp(moved[i] + coordinates[i].moved, -kFarthest, kFarthest);
    }
    const double tried = (*likelihood)(moved);
    if (!(tried > value + kLeastGain)) return value;
    value = tried;
    *logs = moved;
  }
}

/// Standard deviations of the coordinates when none of them is known: from the
/// inverse of the likelihood's curvature over all whose own curvature shows.
std::vector<double> MarginalSigmas(Likelihood* likelihood,
                                   const std::vector<Coordinate>& coordinates,
                                   double value,
                                   const std::vector<double>& logs) {
  std::vector<double> sigmas(logs.size(),
                             std::numeric_limits<double>::infinity());
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    if (std::isfinite(coordinates[i].sigma)) shown.push_back(i);
  }
  const auto n = static_cast<Eigen::Index>(shown.size());
  const auto coordinate = [&](Eigen::Index i) {
    return shown[static_cast<std::size_t>(i)];
  };
  const auto step = [&](Eigen::Index i) {
    return std::clamp(coordinates[coordinate(i)].sigma, kSettled, kFirstStep);
  };
  const auto at = [&](Eigen::Index i, double steps_i, Eigen::Index j,
                      double steps_j) {
    std::vector<double> moved = logs;
    moved[coordinate(i)] += steps_i * step(i);
    moved[coordinate(j)] += steps_j * step(j);
    return (*likelihood)(moved);
  };
  Eigen::MatrixXd curvature(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    curvature(i, i) = 2.0 * value - at(i, 1.0, i, 0.0) - at(i, -1.0, i, 0.0);
    // Both corners, so that the third derivatives fall out.
    for (Eigen::Index j = 0; j < i; ++j) {
      curvature(i, j) = curvature(j, i) =
          value - 0.5 * (at(i, 1.0, j, 1.0) + at(i, -1.0, j, -1.0));
    }
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      curvature(i, j) -= 0.5 * (curvature(i, i) + curvature(j, j));
      curvature(j, i) = curvature(i, j);
    }
  }
  const Eigen::LLT<Eigen::MatrixXd> llt(curvature);
  if (llt.info() != Eigen::Success) return sigmas;
  const Eigen::MatrixXd covariance = llt.solve(Eigen::MatrixXd::Identity(n, n));
  for (Eigen::Index i = 0; i < n; ++i) {
    sigmas[coordinate(i)] = step(i) * std::sqrt(covariance(i, i));
  }
  return sigmas;
}

}  // namespace

NoiseEstimate EstimateNoise(const Dataset& dataset,
                            const std::function<void(double)>& progress) {
  Likelihood likelihood(dataset);
  const std::size_t count = likelihood.size();
  std::vector<double> logs(count, 0.0);
  std::vector<Coordinate> coordinates(count);
  NoiseEstimate estimate;
  double value = likelihood(logs);
  estimate.log_likelihood_before = value;
  for (int sweep = 0; sweep < kSweeps && !estimate.converged; ++sweep) {
    for (std::size_t i = 0; i < count; ++i) {
      value = Climb(&likelihood, i, value, &logs, &coordinates[i]);
      if (progress) {
        progress(
            (sweep + static_cast<double>(i + 1) / static_cast<double>(count)) /
            kSweeps);
      }
    }
    // The first parabolas are too wide to settle anything.
    estimate.converged =
        sweep > 0 &&
        std::all_of(coordinates.begin(), coordinates.end(),
                    [](const Coordinate& c) { return c.IsSettled(); });
    if (!estimate.converged) {
      value = Extrapolate(&likelihood, coordinates, value, &logs);
    }
  }
  estimate.log_likelihood_after = value;
  const std::vector<double> sigmas =
      MarginalSigmas(&likelihood, coordinates, value, logs);
  for (std::size_t i = 0; i < count; ++i) {
    estimate.factors.push_back(
        {likelihood.name(i), std::exp(logs[i]), sigmas[i]});
  }
  return estimate;
}

}  // namespace hindsight
