#ifndef HINDSIGHT_MEASUREMENTS_HEIGHT_FIX_H_
#define HINDSIGHT_MEASUREMENTS_HEIGHT_FIX_H_

#include <tuple>

#include "measurements/model.h"

namespace hindsight {

/// Height above the WGS-84 ellipsoid of a point of the vehicle (barometer,
/// depth gauge with the sign turned, height map).
///   z = h(p_e + C_eb l) + offset;  residual [m], up positive.
struct HeightFix {
  double height = 0.0;  ///< measured [m]
  double sigma = 1.0;   ///< [m]

  /// For base/packed_words.h.
  template <class Self>
  static auto Fields(Self& z) {
    return std::tie(z.height, z.sigma);
  }

  /// Multiplies the standard deviations.
  void ScaleSigma(double factor) { sigma *= factor; }
  static constexpr int rows() { return 1; }
  void Evaluate(const ModelContext& context, LinearizedMeasurement* out) const;
};

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_HEIGHT_FIX_H_
