#ifndef HINDSIGHT_MEASUREMENTS_ACOUSTIC_FIX_H_
#define HINDSIGHT_MEASUREMENTS_ACOUSTIC_FIX_H_

#include <tuple>

#include "measurements/model.h"

namespace hindsight {

/// Range and bearing from the vehicle to a transponder at a known place p_t:
/// one leg of a long-baseline net (range alone) or an ultra-short baseline
/// array on the vehicle (bearing, with or without range). With p the position
/// of the array's point at lever arm l and s its axes (forward, right, down),
///   r = |p_t - p|,   u_s = C_se (p_t - p)/r,
///   range = (1 + k) r,   0 = e_1 . u_s,   0 = e_2 . u_s,
/// k the error of the sound speed, e_1 and e_2 the unit vectors across the
/// measured direction towards larger azimuth (from forward to right) and larger
/// depression; residuals [m] and [rad]. Regular in every direction, unlike the
/// angles themselves.
struct AcousticFix {
  bool has_range = true;
  bool has_bearing = false;
  Eigen::Vector3d p_t_e = Eigen::Vector3d::Zero();  ///< transponder, ECEF [m]
  double range = 0.0;                               ///< measured [m]
  double azimuth = 0.0;                             ///< measured [rad]
  double depression = 0.0;                          ///< measured [rad]
  double sigma_range = 1.0;                         ///< [m]
  double sigma_bearing = 0.01;                      ///< across, each [rad]

  /// For base/packed_words.h.
  template <class Self>
  static auto Fields(Self& z) {
    return std::tie(z.has_range, z.has_bearing, z.p_t_e, z.range, z.azimuth,
                    z.depression, z.sigma_range, z.sigma_bearing);
  }

  /// Multiplies the standard deviations.
  void ScaleSigma(double factor) {
    sigma_range *= factor;
    sigma_bearing *= factor;
  }
  int rows() const { return (has_range ? 1 : 0) + (has_bearing ? 2 : 0); }
  int Component(int row) const { return has_range ? row : row + 1; }
  void Evaluate(const ModelContext& context, LinearizedMeasurement* out) const;
};

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_ACOUSTIC_FIX_H_
