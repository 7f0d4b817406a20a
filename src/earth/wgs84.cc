#include "earth/wgs84.h"

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/NormalGravity.hpp>
#include <cmath>

#include "base/text.h"
#include "base/units.h"

namespace hindsight {
namespace {

constexpr double kJ2 = 1.082629821e-3;
constexpr double kEccentricity2 = kEarthFlattening * (2.0 - kEarthFlattening);

}  // namespace

std::optional<std::string> WhyNotNearEarth(const Geodetic& g) {
  const auto beyond = [](const char* name, double value, const char* unit,
                         const char* range) {
    return std::string("the ") + name + " is " + FormatNumber(value) + " " +
           unit + "; expected " + range;
  };
  if (std::abs(g.latitude) > kPi / 2.0) {
    return beyond("latitude", g.latitude / kDegree, "deg", "-90 to 90 deg");
  }
  if (g.longitude < -kPi || g.longitude > 2.0 * kPi) {
    return beyond("longitude", g.longitude / kDegree, "deg", "-180 to 360 deg");
  }
  if (g.height < -2e4 || g.height > 1e8) {
    return beyond("height", g.height, "m", "-20000 to 1e8 m");
  }
  return std::nullopt;
}

Eigen::Vector3d EcefFromGeodetic(const Geodetic& g) {
  Eigen::Vector3d p;
  GeographicLib::Geocentric::WGS84().Forward(g.latitude / kDegree,
                                             g.longitude / kDegree, g.height,
                                             p.x(), p.y(), p.z());
  return p;
}

Geodetic GeodeticFromEcef(const Eigen::Vector3d& p_e) {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  Geodetic g;
  GeographicLib::Geocentric::WGS84().Reverse(
      p_e.x(), p_e.y(), p_e.z(), latitude_deg, longitude_deg, g.height);
  g.latitude = latitude_deg * kDegree;
  // GeographicLib gives -180 where y is a negative zero.
  g.longitude = longitude_deg == -180.0 ? kPi : longitude_deg * kDegree;
  return g;
}

namespace {

Eigen::Matrix3d NedAxes(double sin_lat, double cos_lat, double sin_lon,
                        double cos_lon) {
  Eigen::Matrix3d C_en;
  C_en << -sin_lat * cos_lon, -sin_lon, -cos_lat * cos_lon,  //
      -sin_lat * sin_lon, cos_lon, -cos_lat * sin_lon,       //
      cos_lat, 0.0, -sin_lat;
  return C_en;
}

}  // namespace

Eigen::Matrix3d NedAxes(double latitude, double longitude) {
  return NedAxes(std::sin(latitude), std::cos(latitude), std::sin(longitude),
                 std::cos(longitude));
}

Eigen::Matrix3d NedAxes(const Eigen::Vector3d& p_e) {
  constexpr double kNearSurface = 0.1 * kEarthSemiMajorAxis;
  const double p2 = p_e.x() * p_e.x() + p_e.y() * p_e.y();
  const double r = std::sqrt(p2 + p_e.z() * p_e.z());
  if (!(std::abs(r - kEarthSemiMajorAxis) < kNearSurface)) {
    const Geodetic g = GeodeticFromEcef(p_e);
    return NedAxes(g.latitude, g.longitude);
  }
  const double p = std::sqrt(p2);
  // Sine and cosine of the parametric latitude, of a better one, of the
  // geodetic one (Bowring 1976): so near to the surface two rounds leave
  // rounding alone, at a third of the time.
  double s = p_e.z();
  double c = (1.0 - kEarthFlattening) * p;
  constexpr double kOuter = kEccentricity2 * kEarthSemiMajorAxis;
  constexpr double kInner = kOuter / (1.0 - kEarthFlattening);
  for (int i = 0; i < 3; ++i) {
    const double scale = 1.0 / std::sqrt(s * s + c * c);
    s *= scale;
    c *= scale;
    if (i == 2) break;
    s = p_e.z() + kInner * s * s * s;
    c = p - kOuter * c * c * c;
    if (i == 0) s *= 1.0 - kEarthFlattening;
  }
  return p > 0.0 ? NedAxes(s, c, p_e.y() / p, p_e.x() / p)
                 : NedAxes(s, c, 0.0, 1.0);
}

double MeridianRadius(double latitude) {
  const double s = std::sin(latitude);
  const double w2 = 1.0 - kEccentricity2 * s * s;
  return kEarthSemiMajorAxis * (1.0 - kEccentricity2) / (w2 * std::sqrt(w2));
}

double TransverseRadius(double latitude) {
  const double s = std::sin(latitude);
  return kEarthSemiMajorAxis / std::sqrt(1.0 - kEccentricity2 * s * s);
}

Eigen::Vector3d TransportRate_n(const Geodetic& g, const Eigen::Vector3d& v_n) {
  const double rate_east = v_n.y() / (TransverseRadius(g.latitude) + g.height);
  const double rate_north = v_n.x() / (MeridianRadius(g.latitude) + g.height);
  return {rate_east, -rate_north, -rate_east * std::tan(g.latitude)};
}

Eigen::Vector3d Gravitation(const Eigen::Vector3d& p_e) {
  Eigen::Vector3d gamma;
  GeographicLib::NormalGravity::WGS84().V0(p_e.x(), p_e.y(), p_e.z(), gamma.x(),
                                           gamma.y(), gamma.z());
  return gamma;
}

Eigen::Matrix3d GravitationGradient(const Eigen::Vector3d& p_e) {
  const double r2 = p_e.squaredNorm();
  const double r = std::sqrt(r2);
  const double mu_r3 = kEarthGM / (r2 * r);
  const double k = 1.5 * kJ2 * kEarthSemiMajorAxis * kEarthSemiMajorAxis / r2;
  const double z2_r2 = p_e.z() * p_e.z() / r2;
  // gamma = -mu/r^3 diag(d) p with d = 1 + k (1,1,3) - 5 k z^2/r^2.
  const double d_xy = 1.0 + k * (1.0 - 5.0 * z2_r2);
  const double d_z = 1.0 + k * (3.0 - 5.0 * z2_r2);
  const Eigen::Vector3d d(d_xy, d_xy, d_z);
  const Eigen::Vector3d u = p_e / r;
  const Eigen::Vector3d grad_k = -2.0 * k * u;  // r * d k/dp
  Eigen::Vector3d grad_z2 = -2.0 * z2_r2 * u;   // r * d (z^2/r^2)/dp
  grad_z2.z() += 2.0 * p_e.z() / r;
  Eigen::Matrix3d gradient = Eigen::Matrix3d(d.asDiagonal());
  gradient -= 3.0 * d.cwiseProduct(u) * u.transpose();
  for (int i = 0; i < 3; ++i) {
    const double base = (i == 2 ? 3.0 : 1.0) - 5.0 * z2_r2;
    gradient.row(i) += u(i) * (base * grad_k - 5.0 * k * grad_z2).transpose();
  }
  return -mu_r3 * gradient;
}

Eigen::Vector3d Gravity(const Eigen::Vector3d& p_e) {
  constexpr double w2 = kEarthRate * kEarthRate;
  Eigen::Vector3d g = Gravitation(p_e);
  g.x() += w2 * p_e.x();
  g.y() += w2 * p_e.y();
  return g;
}

}  // namespace hindsight
