#include <cmath>

#include "simulation/sensor_errors.h"

namespace hindsight {
namespace {

/// Numbers of the random streams; those of aiding sensors come from names.
enum Stream : std::uint64_t {
  kGyroNoise = 1,
  kGyroBias,
  kGyroWalk,
  kAccelNoise,
  kAccelBias,
  kAccelWalk,
  kAccelScale,
  kGyroScale,
};

Eigen::Vector3d StartBias(const Eigen::Vector3d& mean,
                          const Eigen::Vector3d& sigma, std::uint64_t seed,
                          Stream stream) {
  return mean + sigma.cwiseProduct(Random(seed, stream).NormalVector3());
}

/// The oracle of GyroWhiteNoise, written apart from it.
double GyroDensity(const ImuNoise& noise, double rate) {
  if (noise.gyro_noise_per_rate == 0.0) return noise.gyro_noise_density;
  return std::hypot(noise.gyro_noise_density, noise.gyro_noise_per_rate * rate);
}

double AccelDensity(const ImuNoise& noise, double) {
  return noise.accel_noise_density;
}

}  // namespace

ImuErrors::ImuErrors(const ImuErrorModel& model, ImuStream::Kind kind,
                     double rate_hz, std::uint64_t seed)
    : kind_(kind),
      dt_(1.0 / rate_hz),
      noise_(model.noise),
      gyro_{StartBias(model.gyro_bias, model.gyro_bias_sigma, seed, kGyroBias),
            Eigen::Vector3d::Ones() + StartBias(model.gyro_scale,
                                                model.gyro_scale_sigma, seed,
                                                kGyroScale),
            model.noise.GyroBiasEvolution().Phi(dt_),
            std::sqrt(model.noise.GyroBiasEvolution().Q(dt_)),
            GyroDensity,
            Random(seed, kGyroNoise),
            Random(seed, kGyroWalk)},
      accel_{
          StartBias(model.accel_bias, model.accel_bias_sigma, seed, kAccelBias),
          Eigen::Vector3d::Ones() + StartBias(model.accel_scale,
                                              model.accel_scale_sigma, seed,
                                              kAccelScale),
          model.noise.AccelBiasEvolution().Phi(dt_),
          std::sqrt(model.noise.AccelBiasEvolution().Q(dt_)),
          AccelDensity,
          Random(seed, kAccelNoise),
          Random(seed, kAccelWalk)} {}

Eigen::Vector3d ImuErrors::Measure(const Eigen::Vector3d& truth,
                                   Channel* channel) const {
  const Eigen::Vector3d bias_before = channel->bias;
  // The start values hold at the first stamp.
  if (!first_ && channel->walk_sigma > 0.0) {
    channel->bias = channel->phi * channel->bias +
                    channel->walk_sigma * channel->walk.NormalVector3();
  }
  const bool increments = kind_ == ImuStream::Kind::kIncrements;
  const double density =
      channel->density(noise_, truth.norm() / (increments ? dt_ : 1.0));
  const Eigen::Vector3d noise = density * channel->noise.NormalVector3();
  const Eigen::Vector3d scaled = channel->scale_factor.cwiseProduct(truth);
  if (increments) {
    return scaled + (0.5 * dt_) * (bias_before + channel->bias) +
           std::sqrt(dt_) * noise;
  }
  return scaled + channel->bias + noise / std::sqrt(dt_);
}

void ImuErrors::Apply(ImuSample* sample) {
  sample->gyro = Measure(sample->gyro, &gyro_);
  sample->accel = Measure(sample->accel, &accel_);
  first_ = false;
}

}  // namespace hindsight
