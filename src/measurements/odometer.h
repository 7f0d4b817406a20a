#ifndef HINDSIGHT_MEASUREMENTS_ODOMETER_H_
#define HINDSIGHT_MEASUREMENTS_ODOMETER_H_

#include <tuple>

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
///
/// As distance increments, z = D + e is the distance travelled since the count
/// before, by the state block kDistance, whose transition distance_link.h has:
/// a speed that is wrong for an instant (rail joints, jolts) does not enter.
/// `sigma.x()` is the error of one increment, independent of all others (slip,
/// ground); e, the block kOffset if the layout has it, is the error of one
/// count (resolution), which enters two increments with opposite signs.
struct Odometer {
  enum class Form {
    kForward,       ///< the speed alone
    kThreeAxis,     ///< the speed with zero side and down velocity
    kNonHolonomic,  ///< zero side and down velocity alone, no odometer needed
    kIncrements,    ///< the distance since the count before
  };
  Form form = Form::kThreeAxis;
  double speed = 0.0;     ///< measured, signed [m/s]; unused by kNonHolonomic
  double distance = 0.0;  ///< of kIncrements, signed [m]
  double t_from = 0.0;    ///< stamp of the count before [s]
  /// Forward, side, down [m/s]; forward [m] of kIncrements.
  Eigen::Vector3d sigma = Eigen::Vector3d::Ones();
  /// Side and down speed of the axle [m/s]; used by kThreeAxis and
  /// kNonHolonomic.
  Eigen::Vector2d side_down = Eigen::Vector2d::Zero();

  /// For base/packed_words.h.
  template <class Self>
  static auto Fields(Self& z) {
    return std::tie(z.form, z.speed, z.distance, z.t_from, z.sigma,
                    z.side_down);
  }

  /// Multiplies the standard deviations.
  void ScaleSigma(double factor) { sigma *= factor; }
  int rows() const {
    return form == Form::kThreeAxis ? 3 : form == Form::kNonHolonomic ? 2 : 1;
  }
  void Evaluate(const ModelContext& context, LinearizedMeasurement* out) const;

 private:
  void EvaluateSpeeds(const ModelContext& context,
                      LinearizedMeasurement* full) const;
  void EvaluateIncrement(const ModelContext& context,
                         LinearizedMeasurement* out) const;
};

/// (1 + k) v_o,x as a kForward odometer would predict it [m/s].
double PredictedSpeed(const ModelContext& context);

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_ODOMETER_H_
