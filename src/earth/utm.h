#ifndef HINDSIGHT_EARTH_UTM_H_
#define HINDSIGHT_EARTH_UTM_H_

#include <Eigen/Core>

#include "earth/local_frame.h"
#include "earth/wgs84.h"

namespace hindsight {

/// One zone of the Universal Transverse Mercator projection on WGS-84 (GeographicLib,
/// which is exact far beyond a zone's edges).
struct UtmZone {
  int number = 31;  ///< 1 to 60
  bool north = true;
};

/// Place of easting, northing [m] and height above the ellipsoid [m].
Geodetic GeodeticFromUtm(const Eigen::Vector3d& p, const UtmZone& zone);

/// Easting, northing and height [m].
Eigen::Vector3d UtmFromGeodetic(const Geodetic& place, const UtmZone& zone);

/// Axes along grid east, grid north and up at a place, turned against true north by
/// the meridian's convergence; its scale, 0.9996 to 1.001, is left out.
LocalFrame UtmAxesAt(const Geodetic& place, const UtmZone& zone);

}  // namespace hindsight

#endif  // HINDSIGHT_EARTH_UTM_H_
