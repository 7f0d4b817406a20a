#include "imu/imu_stream.h"

namespace hindsight {
namespace {

Evolution BiasEvolution(double walk, double tau) {
  Evolution evolution = Evolution::RandomWalk(walk);
  if (walk > 0.0 && tau < std::numeric_limits<double>::infinity()) {
    evolution.kind = Evolution::Kind::kGaussMarkov;
    evolution.tau = tau;
  }
  return evolution;
}

}  // namespace

Evolution ImuNoise::GyroBiasEvolution() const {
  return BiasEvolution(gyro_bias_walk, gyro_bias_tau);
}

Evolution ImuNoise::AccelBiasEvolution() const {
  return BiasEvolution(accel_bias_walk, accel_bias_tau);
}

}  // namespace hindsight
