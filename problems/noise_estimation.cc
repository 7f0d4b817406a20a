#include "problems/noise_estimation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "alignment/start.h"
#include "base/error.h"
#include "dataset/timeline_builder.h"

namespace hindsight {
namespace {

constexpr int kSweeps = 4;
constexpr double kSettled = 0.02;   // change of ln(factor) in a sweep
constexpr double kFirstStep = 0.7;  // a factor of two
constexpr double kFarthest = 7.0;   // a factor of a thousand
constexpr double kCurvatureStep = 0.1;

/// The likelihood of a data set as a function of the logarithms of its noise
/// factors.
class Likelihood {
 public:
  explicit Likelihood(const Dataset& dataset) : dataset_(dataset) {
    // A prior is no noise that the data could tell.
    for (AidingStream& stream : dataset_.streams) {
      is_noise_.push_back(stream.sensor.type != SensorType::kVehicleLevel);
      stream.sensor.gate_probability.reset();
      stream.sensor.loss = RobustLoss();
      names_.push_back(stream.sensor.name);
    }
    names_.push_back("imu.gyro");
    names_.push_back("imu.accel");
    is_noise_.resize(names_.size(), true);
    applied_.assign(names_.size(), 0.0);
    start_ = FindStart(dataset_, -std::numeric_limits<double>::infinity(),
                       std::numeric_limits<double>::infinity());
  }

  const std::vector<std::string>& names() const { return names_; }
  bool is_noise(std::size_t i) const { return is_noise_[i]; }

  double operator()(const std::vector<double>& logs) {
    Apply(logs);
    TimelineOptions options;
    options.t_begin = start_.report.t;
    options.t_end = dataset_.imu.t_end();
    Timeline timeline = BuildTimeline(dataset_, options);
    Prior prior = start_.prior;
    prior.x.t = timeline.node(0).t;
    try {
      const LinearTape tape =
          RunExtendedKalmanFilter(start_.layout, prior, &timeline);
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
  void Apply(const std::vector<double>& logs) {
    const std::size_t streams = dataset_.streams.size();
    for (std::size_t i = 0; i < streams; ++i) {
      const double factor = std::exp(logs[i] - applied_[i]);
      if (factor == 1.0) continue;
      for (Measurement& z : dataset_.streams[i].measurements) {
        ScaleSigma(factor, &z);
      }
    }
    dataset_.imu.noise.gyro_noise_density *=
        std::exp(logs[streams] - applied_[streams]);
    dataset_.imu.noise.accel_noise_density *=
        std::exp(logs[streams + 1] - applied_[streams + 1]);
    applied_ = logs;
  }

  Dataset dataset_;
  Start start_;
  std::vector<std::string> names_;
  std::vector<bool> is_noise_;
  std::vector<double> applied_;
};

/// Climbs along one coordinate: doubles the step while it gains, then halves it
/// about the best point.
double Climb(Likelihood* likelihood, std::size_t i, double value,
             std::vector<double>* logs) {
  double step = kFirstStep;
  const auto at = [&](double x) {
    std::vector<double> moved = *logs;
    moved[i] = x;
    return (*likelihood)(moved);
  };
  double best = (*logs)[i];
  while (step > 0.5 * kSettled) {
    bool gained = false;
    for (const double direction : {1.0, -1.0}) {
      const double x = best + direction * step;
      if (std::abs(x) > kFarthest) continue;
      const double moved = at(x);
      if (moved <= value) continue;
      value = moved;
      best = x;
      gained = true;
      break;
    }
    if (!gained) step *= 0.5;
  }
  (*logs)[i] = best;
  return value;
}

double LogSigma(Likelihood* likelihood, std::size_t i, double value,
                const std::vector<double>& logs) {
  std::vector<double> moved = logs;
  moved[i] = logs[i] + kCurvatureStep;
  const double plus = (*likelihood)(moved);
  moved[i] = logs[i] - kCurvatureStep;
  const double minus = (*likelihood)(moved);
  const double curvature =
      (2.0 * value - plus - minus) / (kCurvatureStep * kCurvatureStep);
  return curvature > 1.0 / (kFarthest * kFarthest)
             ? 1.0 / std::sqrt(curvature)
             : std::numeric_limits<double>::infinity();
}

}  // namespace

NoiseEstimate EstimateNoise(const Dataset& dataset,
                            const std::function<void(double)>& progress) {
  Likelihood likelihood(dataset);
  const std::size_t count = likelihood.names().size();
  std::vector<double> logs(count, 0.0);
  NoiseEstimate estimate;
  double value = likelihood(logs);
  estimate.log_likelihood_before = value;
  for (int sweep = 0; sweep < kSweeps && !estimate.converged; ++sweep) {
    const std::vector<double> before = logs;
    for (std::size_t i = 0; i < count; ++i) {
      if (!likelihood.is_noise(i)) continue;
      value = Climb(&likelihood, i, value, &logs);
      if (progress) {
        progress(
            (sweep + static_cast<double>(i + 1) / static_cast<double>(count)) /
            (kSweeps + 1));
      }
    }
    double largest = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      largest = std::max(largest, std::abs(logs[i] - before[i]));
    }
    estimate.converged = largest < 2.0 * kSettled;
  }
  estimate.log_likelihood_after = value;
  for (std::size_t i = 0; i < count; ++i) {
    if (!likelihood.is_noise(i)) continue;
    estimate.factors.push_back({likelihood.names()[i], std::exp(logs[i]),
                                LogSigma(&likelihood, i, value, logs)});
  }
  return estimate;
}

}  // namespace hindsight
