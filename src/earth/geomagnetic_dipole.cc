#include "earth/geomagnetic_dipole.h"

#include "earth/wgs84.h"

namespace hindsight {

Eigen::Vector3d DipoleField(const Eigen::Vector3d& p_e) {
  constexpr double kReferenceRadius = 6371200.0;       // a [m]
  const Eigen::Vector3d M(-1.4509, 4.6525, -29.4048);  // [uT]
  const double r = p_e.norm();
  const double ratio = kReferenceRadius / r;
  const Eigen::Vector3d up = p_e / r;
  const Eigen::Vector3d B_e =
      ratio * ratio * ratio * (3.0 * M.dot(up) * up - M);
  return NedAxes(p_e).transpose() * B_e;
}

}  // namespace hindsight
