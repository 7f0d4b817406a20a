#ifndef HINDSIGHT_MEASUREMENTS_DVL_H_
#define HINDSIGHT_MEASUREMENTS_DVL_H_

#include <Eigen/Core>
#include <array>
#include <tuple>

#include "measurements/model.h"

namespace hindsight {

/// A Doppler velocity log: the velocity of its transducer over the bottom or
/// through the water, in its own axes d (forward, right, down).
///   v_d = C_db (C_be (v_e + C_en w) + w_eb x l) + e,   C_db = Exp(m)
///   C_db(nominal), z_i = (1 + k) b_i . v_d,
/// w = -v_c in water track, v_c the current, and g in bottom track, a bottom
/// that moves or an echo that the water drags along (both NED); e a lasting
/// error of the instrument (d), m the boresight, b_i the axes of d in the
/// three-axis form and the directions of the beams in the other.
/// Rows are the components that are there: any beam may drop out. A Janus beam
/// i = 0..3 looks down and out:
///   b_i = (sin a cos c_i, sin a sin c_i, cos a),   c_i = azimuth + i 90 deg,
/// a the beam angle from the vertical; z_i is positive as the transducer moves
/// along the beam. Residual [m/s].
struct Dvl {
  enum class Form { kThreeAxis, kBeams };
  static constexpr int kMaxComponents = 4;

  Form form = Form::kThreeAxis;
  bool water = false;  ///< water track: relative to the current
  /// Which components were received; the fourth is a beam's alone.
  std::array<bool, kMaxComponents> valid = {true, true, true, true};
  double beam_angle = 0.0;  ///< a [rad]
  double beam_azimuth =
      0.0;  ///< of the first beam, from forward to right [rad]
  Eigen::Vector4d speed = Eigen::Vector4d::Zero();  ///< measured [m/s]
  Eigen::Vector4d sigma = Eigen::Vector4d::Ones();  ///< [m/s]

  /// For base/packed_words.h.
  template <class Self>
  static auto Fields(Self& z) {
    return std::tie(z.form, z.water, z.valid, z.beam_angle, z.beam_azimuth,
                    z.speed, z.sigma);
  }

  /// Multiplies the standard deviations.
  void ScaleSigma(double factor) { sigma *= factor; }
  int components() const { return form == Form::kThreeAxis ? 3 : 4; }
  int rows() const;
  int Component(int row) const;
  /// b_i in d.
  Eigen::Vector3d Direction(int component) const;
  void Evaluate(const ModelContext& context, LinearizedMeasurement* out) const;
};

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_DVL_H_
