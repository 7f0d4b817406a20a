#include "earth/utm.h"

#include <GeographicLib/TransverseMercator.hpp>
#include <cmath>

#include "base/units.h"

namespace hindsight {
namespace {

constexpr double kFalseEasting = 500e3;  // [m]
constexpr double kFalseNorthing = 10e6;  // of southern zones [m]

double MeridianOf(const UtmZone& zone) { return 6.0 * zone.number - 183.0; }

double NorthingOfEquator(const UtmZone& zone) {
  return zone.north ? 0.0 : kFalseNorthing;
}

}  // namespace

Geodetic GeodeticFromUtm(const Eigen::Vector3d& p, const UtmZone& zone) {
  double latitude = 0.0;
  double longitude = 0.0;
  GeographicLib::TransverseMercator::UTM().Reverse(
      MeridianOf(zone), p.x() - kFalseEasting, p.y() - NorthingOfEquator(zone),
      latitude, longitude);
  return {latitude * kDegree, longitude * kDegree, p.z()};
}

Eigen::Vector3d UtmFromGeodetic(const Geodetic& place, const UtmZone& zone) {
  double x = 0.0;
  double y = 0.0;
  GeographicLib::TransverseMercator::UTM().Forward(
      MeridianOf(zone), place.latitude / kDegree, place.longitude / kDegree, x,
      y);
  return {x + kFalseEasting, y + NorthingOfEquator(zone), place.height};
}

LocalFrame UtmAxesAt(const Geodetic& place, const UtmZone& zone) {
  double x = 0.0;
  double y = 0.0;
  double convergence = 0.0;
  double scale = 0.0;
  GeographicLib::TransverseMercator::UTM().Forward(
      MeridianOf(zone), place.latitude / kDegree, place.longitude / kDegree, x,
      y, convergence, scale);
  const double c = std::cos(convergence * kDegree);
  const double s = std::sin(convergence * kDegree);
  Eigen::Matrix3d C_nl;
  C_nl << -s, c, 0.0, c, s, 0.0, 0.0, 0.0, -1.0;
  const Eigen::Vector3d p_e = EcefFromGeodetic(place);
  return {p_e, NedAxes(p_e) * C_nl};
}

}  // namespace hindsight
