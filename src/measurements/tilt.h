#ifndef HINDSIGHT_MEASUREMENTS_TILT_H_
#define HINDSIGHT_MEASUREMENTS_TILT_H_

#include <tuple>

#include "measurements/model.h"

namespace hindsight {

/// An accelerometer as a sensor of tilt: of a body that does not accelerate
/// over the ground it reads the opposite of gravity,
///   f_b = (1 + s_a) C_bn (-g e_D) + b_a,
/// e_D downward, s_a and b_a the accelerometer's scale factors and bias as far
/// as the layout has them; three rows [m/s^2] in body axes.
struct Tilt {
  Eigen::Vector3d f_b = Eigen::Vector3d::Zero();  ///< reading [m/s^2]
  double gravity = 9.80665;                       ///< g [m/s^2]
  double sigma = 0.3;                             ///< per axis [m/s^2]

  /// For base/packed_words.h.
  template <class Self>
  static auto Fields(Self& z) {
    return std::tie(z.f_b, z.gravity, z.sigma);
  }

  /// Multiplies the standard deviations.
  void ScaleSigma(double factor) { sigma *= factor; }
  static constexpr int rows() { return 3; }
  void Evaluate(const ModelContext& context, LinearizedMeasurement* out) const;
};

/// What the model predicts of C_nb f_b without errors of the accelerometer, and
/// the derivative of C_nb^ f_b, predicted, by psi. The third row, of the
/// downward component, is zero: it says nothing of the attitude.
Eigen::Vector3d ForceAtRest_n(double gravity);
Eigen::Matrix3d ForceAtRestByPsi_n(double gravity);

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_TILT_H_
