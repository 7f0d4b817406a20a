#ifndef HINDSIGHT_MEASUREMENTS_VEHICLE_LEVEL_H_
#define HINDSIGHT_MEASUREMENTS_VEHICLE_LEVEL_H_

#include <tuple>

#include "measurements/model.h"

namespace hindsight {

/// The vehicle of the stream Sensor::vehicle does not lean to a side:
///   z = 0 = e_y' C_ob C_bn e_z,
/// the sine of its roll but for the cosine of its pitch; residual [1].
/// A prior rather than a measurement: n of them, each with sqrt(n) times the
/// sigma of the mean, say that the vehicle is level on average. It makes the
/// mounting's rotation about the forward axis observable, which no velocity
/// shows.
struct VehicleLevel {
  double sigma = 1.0;  ///< of this one [rad]

  /// For base/packed_words.h.
  template <class Self>
  static auto Fields(Self& z) {
    return std::tie(z.sigma);
  }

  /// Does nothing: a prior is not fitted to the data.
  void ScaleSigma(double) {}
  static constexpr int rows() { return 1; }
  void Evaluate(const ModelContext& context, LinearizedMeasurement* out) const;
};

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_VEHICLE_LEVEL_H_
