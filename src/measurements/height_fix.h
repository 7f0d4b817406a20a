#ifndef HINDSIGHT_MEASUREMENTS_HEIGHT_FIX_H_
#define HINDSIGHT_MEASUREMENTS_HEIGHT_FIX_H_

#include "measurements/model.h"

namespace hindsight {

/// Height above the WGS-84 ellipsoid of a point of the vehicle (barometer,
/// depth gauge with the sign turned, height map).
///   z = h(p_e + C_eb l) + offset;  residual [m], up positive.
struct HeightFix {
  double height = 0.0;  ///< measured [m]
  double sigma = 1.0;   ///< [m]

  /// Multiplies the standard deviations.
  void ScaleSigma(double factor) { sigma *= factor; }
  static constexpr int rows() { return 1; }
  void Evaluate(const ModelContext& context, LinearizedMeasurement* out) const;
};

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_HEIGHT_FIX_H_
