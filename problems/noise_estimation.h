#ifndef HINDSIGHT_PROBLEMS_NOISE_ESTIMATION_H_
#define HINDSIGHT_PROBLEMS_NOISE_ESTIMATION_H_

#include <functional>
#include <string>
#include <vector>

#include "dataset/dataset.h"

namespace hindsight {

/// By what the stated noise of a sensor has to be multiplied.
struct NoiseFactor {
  /// A stream, "imu.gyro" or "imu.accel"; of a stream with a Gauss-Markov error
  /// its "NAME.white", "NAME.gauss_markov" and "NAME.gauss_markov_tau"; of a
  /// magnetometer's disturbance "NAME.disturbance" and "NAME.disturbance_tau".
  std::string name;
  double factor = 1.0;
  /// Standard deviation of ln(factor), all factors being unknown together, from
  /// the curvature of the likelihood; infinite where the data do not tell.
  double log_sigma = 0.0;
};

struct NoiseEstimate {
  std::vector<NoiseFactor> factors;
  double log_likelihood_before = 0.0;
  double log_likelihood_after = 0.0;
  bool converged = false;
};

/// Maximum-likelihood noise: the factors on every sensor's standard deviations,
/// on sigma and correlation time of errors that last, and on the IMU's two
/// white-noise densities that maximise the likelihood of the forward filter's
/// innovations (Schweppe 1965). Sought by parabolas along the logarithm of each
/// factor in turn, and along the sum of the moves of such a sweep. Gates and
/// robust losses are off meanwhile: they would judge by the very sigmas that
/// are sought. Clocks begin where ChooseClocks has them. `progress` gets the
/// fraction done.
NoiseEstimate EstimateNoise(const Dataset& dataset,
                            const std::function<void(double)>& progress = {});

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_NOISE_ESTIMATION_H_
