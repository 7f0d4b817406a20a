#ifndef HINDSIGHT_MEASUREMENTS_STATIONARY_H_
#define HINDSIGHT_MEASUREMENTS_STATIONARY_H_

#include <tuple>

#include "measurements/model.h"

namespace hindsight {

/// The vehicle stands: z = 0 = C_ne v_e (+ v), residual [m/s] NED.
struct ZeroVelocity {
  double sigma = 0.01;  ///< per axis [m/s]

  /// For base/packed_words.h.
  template <class Self>
  static auto Fields(Self& z) {
    return std::tie(z.sigma);
  }

  /// Multiplies the standard deviations.
  void ScaleSigma(double factor) { sigma *= factor; }
  static constexpr int rows() { return 3; }
  void Evaluate(const ModelContext& context, LinearizedMeasurement* out) const;
};

/// The vehicle does not turn over the Earth:
///   w_ib (reading, mean over the interval) = C_be w_ie + b_g,
/// residual [rad/s] in body axes.
struct ZeroAngularRate {
  Eigen::Vector3d w_ib_b = Eigen::Vector3d::Zero();  ///< mean reading [rad/s]
  double sigma = 1e-4;                               ///< per axis [rad/s]

  /// For base/packed_words.h.
  template <class Self>
  static auto Fields(Self& z) {
    return std::tie(z.w_ib_b, z.sigma);
  }

  /// Multiplies the standard deviations.
  void ScaleSigma(double factor) { sigma *= factor; }
  static constexpr int rows() { return 3; }
  void Evaluate(const ModelContext& context, LinearizedMeasurement* out) const;
};

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_STATIONARY_H_
