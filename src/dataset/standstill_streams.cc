#include <algorithm>
#include <cmath>

#include "dataset/ground_motion.h"
#include "dataset/timeline_builder.h"

namespace hindsight {
namespace {

constexpr double kPeriod = 1.0;  // between pseudo-measurements [s]

AidingStream MakeStream(const char* name, SensorType type) {
  AidingStream stream;
  stream.sensor.name = name;
  stream.sensor.type = type;
  return stream;
}

/// Mean rate of the samples in [begin, end].
Eigen::Vector3d MeanRate(const ImuStream& imu, double begin, double end) {
  const auto first =
      std::lower_bound(imu.samples.begin(), imu.samples.end(), begin,
                       [](const ImuSample& s, double t) { return s.t < t; });
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double weight = 0.0;
  for (auto it = first; it != imu.samples.end() && it->t <= end; ++it) {
    sum += it->gyro;
    if (imu.kind == ImuStream::Kind::kRates) {
      weight += 1.0;
    } else if (it != imu.samples.begin()) {
      weight += it->t - (it - 1)->t;
    } else {
      sum -= it->gyro;  // its interval's length is not known
    }
  }
  return weight > 0.0 ? Eigen::Vector3d(sum / weight)
                      : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

bool HasStream(const Dataset& dataset, const char* name) {
  return std::any_of(
      dataset.streams.begin(), dataset.streams.end(),
      [name](const AidingStream& s) { return s.sensor.name == name; });
}

}  // namespace

void AddStandstillStreams(Dataset* dataset) {
  const StationaryOptions& options = dataset->stationary;
  if (!options.enabled || HasStream(*dataset, "zero_velocity")) return;
  AidingStream velocity =
      MakeStream("zero_velocity", SensorType::kZeroVelocity);
  AidingStream rate =
      MakeStream("zero_angular_rate", SensorType::kZeroAngularRate);
  const int velocity_index = static_cast<int>(dataset->streams.size());
  for (const TimeInterval& rest : FindRests(*dataset)) {
    const int count = static_cast<int>((rest.end - rest.begin) / kPeriod);
    for (int i = 0; i < count; ++i) {
      const double begin = rest.begin + i * kPeriod;
      const double t = begin + 0.5 * kPeriod;
      velocity.measurements.push_back(
          {t, velocity_index, false, ZeroVelocity{options.velocity_sigma}});
      rate.measurements.push_back(
          {t, velocity_index + 1, false,
           ZeroAngularRate{MeanRate(dataset->imu, begin, begin + kPeriod),
                           options.rate_sigma}});
    }
  }
  dataset->streams.push_back(std::move(velocity));
  dataset->streams.push_back(std::move(rate));
}

}  // namespace hindsight
