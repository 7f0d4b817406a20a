#ifndef HINDSIGHT_RECEIVER_ERRORS_BIAS_RIDGE_H_
#define HINDSIGHT_RECEIVER_ERRORS_BIAS_RIDGE_H_

#include <vector>

#include "receiver_errors/parameter_tuning.h"

namespace hindsight {

/// Between the taus of neighbours on a ridge.
inline constexpr double kRidgeStep = 4.0;

/// Of a bias throughout, with the likeliest sigma, sigma down and factor on the noise of the
/// IMU of a tau.
struct RidgePoint {
  ErrorParameters parameters;
  double value = 0.0;  ///< ln of the posterior
};

/// The points beside the parameters `found` in both directions, to where odds are a
/// thousand against them, of falling tau. Ends early once the effort is spent.
std::vector<RidgePoint> FindRidge(const ErrorParameters& found,
                                  ParameterTuning* tuning);

/// The ridge at a tau; at its ends beyond them.
ErrorParameters PointAtTau(const std::vector<RidgePoint>& falling, double tau);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_BIAS_RIDGE_H_
