#ifndef HINDSIGHT_EARTH_GEOMAGNETIC_DIPOLE_H_
#define HINDSIGHT_EARTH_GEOMAGNETIC_DIPOLE_H_

#include <Eigen/Core>

namespace hindsight {

/// Least and largest norm of the Earth's magnetic field at its surface [uT].
inline constexpr double kLeastMagneticField = 22.0;
inline constexpr double kLargestMagneticField = 67.0;

/// The field of the dipole in the Earth's centre at p_e, in NED axes [uT]:
///   B = (a/r)^3 (3 (M . r^) r^ - M),  M = (g11, h11, g10),
/// from the first Gauss coefficients of IGRF-13 (2020). True dips differ from
/// it by up to some 25 deg, norms by a third: it tells the hemisphere and the
/// unit, no heading.
Eigen::Vector3d DipoleField(const Eigen::Vector3d& p_e);

}  // namespace hindsight

#endif  // HINDSIGHT_EARTH_GEOMAGNETIC_DIPOLE_H_
