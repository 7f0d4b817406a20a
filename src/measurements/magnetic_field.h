#ifndef HINDSIGHT_MEASUREMENTS_MAGNETIC_FIELD_H_
#define HINDSIGHT_MEASUREMENTS_MAGNETIC_FIELD_H_

#include <tuple>

#include "measurements/model.h"

namespace hindsight {

/// Magnetic field at the vehicle. With the field of the surroundings
///   m_n = Rz(D) (horizontal, 0, down)' + d_n,
/// D the declination (Sensor::magnetic, or its block), d_n the disturbance
/// block, h_b the hard iron (Sensor::magnetic, or its block):
///   kVector:   field_b = C_bn m_n + h_b, three rows [uT];
///   kHeading:  0 = azimuth(C_nb (field_b - h_b)) - azimuth(m_n), one row
///              [rad], sigma / |m_n horizontal|: norm and dip do not matter,
///              and tilt only by how it levels the field.
/// An error of the sensor beyond its noise (kSensorError) adds to h_b, in uT: a
/// current beside it turns with the vehicle. Of kHeading that needs OwnFieldOf;
/// else the error is of the azimuth [rad].
struct MagneticField {
  enum class Form { kVector, kHeading };
  Eigen::Vector3d field_b = Eigen::Vector3d::Zero();  ///< body axes [uT]
  double sigma = 1.0;                                 ///< per axis [uT]
  Form form = Form::kHeading;

  /// For base/packed_words.h.
  template <class Self>
  static auto Fields(Self& z) {
    return std::tie(z.field_b, z.sigma, z.form);
  }

  /// Multiplies the standard deviation.
  void ScaleSigma(double factor) { sigma *= factor; }
  int rows() const { return form == Form::kVector ? 3 : 1; }
  void Evaluate(const ModelContext& context, LinearizedMeasurement* out) const;
};

/// The block of h_b where all of its axes are estimated, or nullptr.
const Block* OwnFieldOf(const ErrorLayout& layout, int sensor);

/// m_n without the disturbance [uT].
Eigen::Vector3d UndisturbedField(const MagneticSurroundings& magnetic,
                                 double declination);

/// Derivative of the azimuth of u_n = C_nb m_b by psi. A vertical vector has no
/// azimuth: a floor of 0.1 uT on its horizontal part only keeps the numbers
/// finite.
Eigen::RowVector3d AzimuthByPsi(const Eigen::Vector3d& u_n);
/// Square of the horizontal part, with that floor [uT^2].
double HorizontalSquare(const Eigen::Vector3d& u_n);

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_MAGNETIC_FIELD_H_
