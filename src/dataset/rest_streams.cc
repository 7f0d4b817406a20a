#include <algorithm>
#include <cmath>

#include "dataset/bias_sigma.h"
#include "dataset/excluded_motion.h"
#include "dataset/rest.h"
#include "imu/mean_reading.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

AidingStream MakeStream(const SensorKind& kind) {
  AidingStream stream;
  stream.sensor.name = kind.name;
  stream.sensor.kind = &kind;
  return stream;
}

Eigen::Vector3d MeanRate(const ImuStream& imu, const TimeInterval& span) {
  return MeanReading(imu, span.begin, span.end).w_ib_b;
}

class StreamBuilder {
 public:
  StreamBuilder(const Rest& rest, Dataset* dataset)
      : rest_(rest), dataset_(*dataset), options_(dataset->stationary) {}

  void AppendRests() {
    const ExcludedMotion aiding(dataset_);
    for (const TimeInterval& span : rest_.at_rest) {
      const std::vector<TimeInterval> windows = WindowsOf(span, options_);
      const double sigma =
          std::max(options_.velocity_sigma,
                   std::sqrt(static_cast<double>(windows.size())) *
                       MeanSpeedSigma(span, aiding));
      for (const TimeInterval& window : windows) {
        const double t = 0.5 * (window.begin + window.end);
        velocity_.measurements.push_back(
            {t, index(), false, ZeroVelocity{sigma}});
        AppendRate(window, options_.rate_sigma);
      }
    }
  }

  void AppendStraight(const TimeInterval& span) {
    const std::vector<TimeInterval> windows = WindowsOf(span, options_);
    if (windows.empty()) return;
    const std::optional<Eigen::Vector3d> bias = BiasNear(span);
    constexpr double kSigmas = 3.0;
    if (!bias || (MeanRate(dataset_.imu, span) - *bias).cwiseAbs().maxCoeff() >
                     kSigmas * options_.rate_sigma) {
      return;
    }
    const double once = std::sqrt(static_cast<double>(windows.size()));
    for (const TimeInterval& window : windows) {
      AppendRate(window, once * options_.rate_sigma);
    }
  }

  void Finish() {
    std::sort(
        rates_.begin(), rates_.end(),
        [](const Measurement& a, const Measurement& b) { return a.t < b.t; });
    rate_.measurements = MeasurementSeries(rates_);
    dataset_.streams.push_back(std::move(velocity_));
    dataset_.streams.push_back(std::move(rate_));
  }

 private:
  int index() const { return static_cast<int>(dataset_.streams.size()); }

  static double MeanSpeedSigma(const TimeInterval& span,
                               const ExcludedMotion& aiding) {
    if (aiding.empty()) return 0.0;
    const double possible = aiding.PossibleSpeed(span);
    return std::isfinite(possible) ? possible : kKnownSpeed;
  }

  void AppendRate(const TimeInterval& window, double sigma) {
    rates_.push_back({0.5 * (window.begin + window.end), index() + 1, false,
                      ZeroAngularRate{MeanRate(dataset_.imu, window), sigma}});
  }

  /// What the gyros read without a turn, if that is known well enough.
  std::optional<Eigen::Vector3d> BiasNear(const TimeInterval& span) const {
    const auto distance = [&span](const TimeInterval& rest) {
      return std::max(rest.begin - span.end, span.begin - rest.end);
    };
    const auto nearest =
        std::min_element(rest_.at_rest.begin(), rest_.at_rest.end(),
                         [&](const TimeInterval& a, const TimeInterval& b) {
                           return distance(a) < distance(b);
                         });
    const ImuNoise& noise = dataset_.imu.noise;
    if (nearest != rest_.at_rest.end()) {
      const double sigma = std::hypot(
          noise.gyro_noise_density / std::sqrt(nearest->length()),
          noise.gyro_bias_walk * std::sqrt(std::max(0.0, distance(*nearest))));
      if (sigma <= options_.rate_sigma) return MeanRate(dataset_.imu, *nearest);
    }
    const InitialState& given = dataset_.initial;
    if (GyroBiasSigma(given).maxCoeff() > options_.rate_sigma) {
      return std::nullopt;
    }
    return given.gyro_bias;
  }

  const Rest& rest_;
  Dataset& dataset_;
  const StationaryOptions& options_;
  AidingStream velocity_ = MakeStream(ZeroVelocityKind());
  AidingStream rate_ = MakeStream(ZeroAngularRateKind());
  std::vector<Measurement> rates_;
};

}  // namespace

void AddRestStreams(const Rest& rest, Dataset* dataset) {
  StreamBuilder builder(rest, dataset);
  builder.AppendRests();
  for (const TimeInterval& span : rest.moving) builder.AppendStraight(span);
  for (const TimeInterval& span : rest.undecided) builder.AppendStraight(span);
  builder.Finish();
}

}  // namespace hindsight
