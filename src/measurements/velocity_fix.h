#ifndef HINDSIGHT_MEASUREMENTS_VELOCITY_FIX_H_
#define HINDSIGHT_MEASUREMENTS_VELOCITY_FIX_H_

#include <tuple>

#include "measurements/model.h"

namespace hindsight {

/// Velocity over the Earth of a point of the vehicle (GNSS Doppler).
///   z = C_ne (v_e + C_eb (w_eb x l)),  w_eb = w_ib - b_g - C_be w_ie,
/// in the NED axes at the state's position; residual [m/s] NED. With coloured
/// noise of the sensor (kColouredNoise) as in PositionFix.
struct VelocityFix {
  Eigen::Vector3d v_n = Eigen::Vector3d::Zero();      ///< measured NED [m/s]
  Eigen::Matrix3d R_n = Eigen::Matrix3d::Identity();  ///< [m^2/s^2]

  /// For base/packed_words.h.
  template <class Self>
  static auto Fields(Self& z) {
    return std::tie(z.v_n, z.R_n);
  }

  /// Multiplies the standard deviations.
  void ScaleSigma(double factor) { R_n *= factor * factor; }
  static constexpr int rows() { return 3; }
  void Evaluate(const ModelContext& context, LinearizedMeasurement* out) const;
};

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_VELOCITY_FIX_H_
