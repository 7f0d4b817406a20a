#ifndef HINDSIGHT_EARTH_WGS84_H_
#define HINDSIGHT_EARTH_WGS84_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>

namespace hindsight {

inline constexpr double kEarthRate = 7.292115e-5;         ///< w_ie [rad/s]
inline constexpr double kEarthSemiMajorAxis = 6378137.0;  ///< a [m]
inline constexpr double kEarthFlattening = 1.0 / 298.257223563;
inline constexpr double kEarthGM = 3.986004418e14;  ///< [m^3/s^2]

/// w_ie resolved in e [rad/s].
inline Eigen::Vector3d EarthRate_e() { return {0.0, 0.0, kEarthRate}; }

/// Geodetic latitude [rad], longitude [rad] in (-pi, pi], height above the
/// WGS-84 ellipsoid [m].
struct Geodetic {
  double latitude = 0.0;
  double longitude = 0.0;
  double height = 0.0;
};

/// What is wrong with a place that a file or a key gives, and what was expected
/// ("the latitude is 91 deg; expected -90 to 90 deg"); nothing of latitudes of
/// -90 to 90 deg, longitudes of -180 to 360 deg and heights from below the
/// deepest sea floor to beyond the satellites of GNSS (-20 km to 100 000 km).
std::optional<std::string> WhyNotNearEarth(const Geodetic& g);

/// ECEF position [m]. Exact at any latitude and height (GeographicLib).
Eigen::Vector3d EcefFromGeodetic(const Geodetic& g);

Geodetic GeodeticFromEcef(const Eigen::Vector3d& p_e);

/// Local north-east-down axes at a latitude and longitude: C_en maps n to e.
Eigen::Matrix3d NedAxes(double latitude, double longitude);

/// C_en at p_e. At the poles longitude is the atan2 of p_e (0 on the axis), so
/// the axes are always orthonormal.
Eigen::Matrix3d NedAxes(const Eigen::Vector3d& p_e);

/// Radii of curvature [m] at a latitude: meridian R_m and transverse R_t.
double MeridianRadius(double latitude);
double TransverseRadius(double latitude);

/// Rate of the NED axes over the Earth, w_en resolved in n [rad/s], for a
/// velocity v_n [m/s]. Singular at the poles: no estimator uses it.
Eigen::Vector3d TransportRate_n(const Geodetic& g, const Eigen::Vector3d& v_n);

/// Gravitation gamma(p_e) [m/s^2], resolved in e: the attraction of the WGS-84
/// normal ellipsoid, without the centrifugal part.
Eigen::Vector3d Gravitation(const Eigen::Vector3d& p_e);

/// d gamma / d p_e [1/s^2], central term and J2: relative error below 1e-4.
Eigen::Matrix3d GravitationGradient(const Eigen::Vector3d& p_e);

/// Gravity g = gamma - w_ie x (w_ie x p) [m/s^2], resolved in e.
Eigen::Vector3d Gravity(const Eigen::Vector3d& p_e);

}  // namespace hindsight

#endif  // HINDSIGHT_EARTH_WGS84_H_
