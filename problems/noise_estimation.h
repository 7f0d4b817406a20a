#ifndef HINDSIGHT_PROBLEMS_NOISE_ESTIMATION_H_
#define HINDSIGHT_PROBLEMS_NOISE_ESTIMATION_H_

#include <functional>
#include <string>
#include <vector>

#include "dataset/dataset.h"

namespace hindsight {

/// By what the stated noise of a sensor has to be multiplied.
struct NoiseFactor {
  std::string name;  ///< a stream, "imu.gyro" or "imu.accel"
  double factor = 1.0;
  /// Standard deviation of ln(factor), from the curvature of the likelihood;
  /// infinite where the data do not tell.
  double log_sigma = 0.0;
};

struct NoiseEstimate {
  std::vector<NoiseFactor> factors;
  double log_likelihood_before = 0.0;
  double log_likelihood_after = 0.0;
  bool converged = false;
};

/// Maximum-likelihood noise: the factors on every sensor's standard deviations
/// and on the IMU's two white-noise densities that maximise the likelihood of
/// the forward filter's innovations (Schweppe 1965), by cyclic line searches in
/// the logarithm. Gates and robust losses are off meanwhile: they would judge
/// by the very sigmas that are sought. `progress` gets the fraction done.
NoiseEstimate EstimateNoise(const Dataset& dataset,
                            const std::function<void(double)>& progress = {});

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_NOISE_ESTIMATION_H_
