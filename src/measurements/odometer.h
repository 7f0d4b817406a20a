#ifndef HINDSIGHT_MEASUREMENTS_ODOMETER_H_
#define HINDSIGHT_MEASUREMENTS_ODOMETER_H_

#include "measurements/model.h"

namespace hindsight {

/// Speed along the track of an axle, and that the axle neither slips sideways
/// nor leaves the ground. In the vehicle axes o (forward, right, down) of the
/// axle at lever arm l,
///   v_o = C_ob (C_be v_e + w_eb x l),   C_ob = Exp(m) C_ob(nominal),
///   z = ((1 + k) v_o,x, v_o,y, v_o,z) = (speed, side, down),
/// side and down being zero unless a sensor measures them.
/// Residual [m/s]: measured - predicted (eq. (44) of the 2002 paper has the
/// opposite sign and navigation axes; its K of eq. (43) is -k).
struct Odometer {
  enum class Form {
    kForward,       ///< the speed alone
    kThreeAxis,     ///< the speed with zero side and down velocity
    kNonHolonomic,  ///< zero side and down velocity alone, no odometer needed
  };
  Form form = Form::kThreeAxis;
  double speed = 0.0;  ///< measured, signed [m/s]; unused by kNonHolonomic
  /// Forward, side, down [m/s].
  Eigen::Vector3d sigma = Eigen::Vector3d::Ones();
  /// Side and down speed of the axle [m/s]; unused by kForward.
  Eigen::Vector2d side_down = Eigen::Vector2d::Zero();

  /// Multiplies the standard deviations.
  void ScaleSigma(double factor) { sigma *= factor; }
  int rows() const {
    return form == Form::kForward ? 1 : form == Form::kThreeAxis ? 3 : 2;
  }
  void Evaluate(const ModelContext& context, LinearizedMeasurement* out) const;
};

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_ODOMETER_H_
