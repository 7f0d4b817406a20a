#ifndef HINDSIGHT_MEASUREMENTS_POSITION_FIX_H_
#define HINDSIGHT_MEASUREMENTS_POSITION_FIX_H_

#include <limits>
#include <tuple>

#include "measurements/model.h"

namespace hindsight {

/// Position of a point of the vehicle: a GNSS antenna, a transponder, or the
/// IMU over a surveyed reference point.
///   z = p_e + C_eb l,  resolved in the NED axes at the measured position;
/// residual [m] NED. With coloured noise e of the sensor (kColouredNoise) the
/// prediction has + C_en e, and R is what is left white. Position reference
/// points: eq. (45) of the 2002 paper, with the opposite sign of the residual.
struct PositionFix {
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();      ///< measured, ECEF [m]
  Eigen::Matrix3d R_n = Eigen::Matrix3d::Identity();  ///< NED covariance [m^2]
  /// What the receiver says of itself, in its own numbers; no model uses it.
  /// NaN: nothing.
  double quality = std::numeric_limits<double>::quiet_NaN();
  double satellites = std::numeric_limits<double>::quiet_NaN();  ///< in use

  /// For base/packed_words.h.
  template <class Self>
  static auto Fields(Self& z) {
    return std::tie(z.p_e, z.R_n, z.quality, z.satellites);
  }

  /// Multiplies the standard deviations.
  void ScaleSigma(double factor) { R_n *= factor * factor; }
  static constexpr int rows() { return 3; }
  void Evaluate(const ModelContext& context, LinearizedMeasurement* out) const;
};

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_POSITION_FIX_H_
