#include "earth/wgs84.h"

#include <gtest/gtest.h>

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/NormalGravity.hpp>
#include <cmath>
#include <vector>

#include "base/units.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPolarRadius = kEarthSemiMajorAxis * (1.0 - kEarthFlattening);

std::vector<Geodetic> Places() {
  std::vector<Geodetic> places;
  for (const double latitude : {-89.9999, -45.0, -1e-9, 0.0, 30.0, 89.9999}) {
    for (const double longitude : {-179.99999, -90.0, 0.0, 60.0, 180.0}) {
      for (const double height : {-10000.0, 0.0, 250.0, 9e3}) {
        places.push_back({latitude * kDegree, longitude * kDegree, height});
      }
    }
  }
  return places;
}

TEST(Wgs84, PlacesNearTheEarthAreThoseOfVehiclesAndSatellites) {
  for (const Geodetic& place : Places()) {
    EXPECT_EQ(WhyNotNearEarth(place), std::nullopt);
  }
  EXPECT_EQ(WhyNotNearEarth({0.0, 2.0 * kPi, 36e6}), std::nullopt);
  EXPECT_EQ(WhyNotNearEarth({91.0 * kDegree, 0.0, 0.0}),
            "the latitude is 91 deg; expected -90 to 90 deg");
  EXPECT_EQ(WhyNotNearEarth({0.0, -181.0 * kDegree, 0.0}),
            "the longitude is -181 deg; expected -180 to 360 deg");
  EXPECT_EQ(WhyNotNearEarth({0.0, 0.0, -7e6}),
            "the height is -7e+06 m; expected -20000 to 1e8 m");
}

TEST(Wgs84, EcefOfKnownPlaces) {
  EXPECT_LT((EcefFromGeodetic({0.0, 0.0, 100.0}) -
             Vector3d(kEarthSemiMajorAxis + 100.0, 0.0, 0.0))
                .norm(),
            2e-9);
  EXPECT_LT((EcefFromGeodetic({0.0, kPi / 2, 0.0}) -
             Vector3d(0.0, kEarthSemiMajorAxis, 0.0))
                .norm(),
            2e-9);
  EXPECT_LT((EcefFromGeodetic({-kPi / 2, 1.0, 10.0}) -
             Vector3d(0.0, 0.0, -kPolarRadius - 10.0))
                .norm(),
            2e-9);
}

TEST(Wgs84, GeodeticRoundTrip) {
  for (const Geodetic& g : Places()) {
    const Geodetic back = GeodeticFromEcef(EcefFromGeodetic(g));
    // A rounding of 1e-9 m in position.
    EXPECT_NEAR(back.latitude, g.latitude, 5e-16 + 2e-9 / 6.3e6);
    EXPECT_NEAR(WrapAngle(back.longitude - g.longitude) * std::cos(g.latitude),
                0.0, 1e-15);
    EXPECT_NEAR(back.height, g.height, 4e-9);
  }
}

TEST(Wgs84, LongitudeIsInTheHalfOpenInterval) {
  EXPECT_EQ(GeodeticFromEcef({-7e6, 0.0, 0.0}).longitude, kPi);
  EXPECT_EQ(GeodeticFromEcef({-7e6, -0.0, 0.0}).longitude, kPi);
  EXPECT_LT(GeodeticFromEcef({-7e6, -1.0, 0.0}).longitude, 0.0);
}

TEST(Wgs84, NedAxesAreThoseOfGeographicLib) {
  for (const Geodetic& g : Places()) {
    std::vector<GeographicLib::Math::real> M(9);
    double x, y, z;
    GeographicLib::Geocentric::WGS84().Forward(
        g.latitude / kDegree, g.longitude / kDegree, g.height, x, y, z, M);
    // Row-major, columns east, north, up.
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> C_enu(
        M.data());
    Matrix3d expected;
    expected << C_enu.col(1), C_enu.col(0), -C_enu.col(2);
    EXPECT_LT((NedAxes(g.latitude, g.longitude) - expected).norm(), 2e-15);
    EXPECT_LT((NedAxes(Vector3d(x, y, z)) - expected).norm(),
              1e-14 / std::cos(g.latitude));
  }
}

TEST(Wgs84, NedAxesAreOrthonormalAtThePoles) {
  for (const double z : {kPolarRadius, -kPolarRadius}) {
    for (const Vector3d& offset :
         {Vector3d(0.0, 0.0, 0.0), Vector3d(1e-3, 0.0, 0.0),
          Vector3d(-1e-9, 1e-9, 5.0)}) {
      const Matrix3d C_en = NedAxes(Vector3d(Vector3d(0.0, 0.0, z) + offset));
      EXPECT_LT((C_en.transpose() * C_en - Matrix3d::Identity()).norm(), 1e-15);
      EXPECT_NEAR(C_en.determinant(), 1.0, 1e-15);
      EXPECT_LT((C_en.col(2) - Vector3d(0.0, 0.0, z < 0.0 ? 1.0 : -1.0)).norm(),
                1e-9);
    }
  }
}

// A small step along the meridian or the parallel is radius times angle.
TEST(Wgs84, RadiiMatchNumericDifference) {
  constexpr double kStep = 1e-4;
  for (const Geodetic& g : Places()) {
    if (std::abs(g.latitude) > 1.5) continue;
    const Matrix3d C_ne = NedAxes(g.latitude, g.longitude).transpose();
    const auto derivative = [&](double north, double east) {
      const Geodetic plus{g.latitude + north, g.longitude + east, g.height};
      const Geodetic minus{g.latitude - north, g.longitude - east, g.height};
      return Vector3d(C_ne *
                      (EcefFromGeodetic(plus) - EcefFromGeodetic(minus)) /
                      (2.0 * kStep));
    };
    // Truncation radius step^2 / 6 = 0.01 m.
    EXPECT_NEAR(derivative(kStep, 0.0).x(),
                MeridianRadius(g.latitude) + g.height, 0.02);
    EXPECT_NEAR(
        derivative(0.0, kStep).y(),
        (TransverseRadius(g.latitude) + g.height) * std::cos(g.latitude), 0.02);
  }
}

TEST(Wgs84, TransportRateMatchesTurnOfTheAxes) {
  const Vector3d v_n(120.0, -80.0, 5.0);
  for (const Geodetic& g : Places()) {
    if (std::abs(g.latitude) > 1.5) continue;
    constexpr double kStep = 0.1;
    const Matrix3d C_en = NedAxes(g.latitude, g.longitude);
    const Vector3d p_e = EcefFromGeodetic(g);
    const Matrix3d change = (NedAxes(Vector3d(p_e + kStep * C_en * v_n)) -
                             NedAxes(Vector3d(p_e - kStep * C_en * v_n))) /
                            (2.0 * kStep);
    const Matrix3d turn = C_en.transpose() * change;  // [w_en_n x]
    const Vector3d w_n(turn(2, 1), turn(0, 2), turn(1, 0));
    EXPECT_LT((TransportRate_n(g, v_n) - w_n).norm(), 1e-13);
  }
}

TEST(Wgs84, GravityAtEquatorAndPole) {
  // Derived constants of WGS 84, NIMA TR8350.2.
  const Vector3d equator = Gravity({kEarthSemiMajorAxis, 0.0, 0.0});
  EXPECT_NEAR(-equator.x(), 9.7803253359, 2e-10);
  EXPECT_NEAR(equator.tail<2>().norm(), 0.0, 1e-15);
  const Vector3d pole = Gravity({0.0, 0.0, kPolarRadius});
  EXPECT_NEAR(-pole.z(), 9.8321849379, 2e-10);
  EXPECT_NEAR(pole.head<2>().norm(), 0.0, 1e-15);
}

TEST(Wgs84, GravityIsNormalToTheEllipsoid) {
  for (const double latitude : {-80.0, -30.0, 10.0, 45.0}) {
    const Geodetic g{latitude * kDegree, 0.7, 0.0};
    const Vector3d g_n = NedAxes(g.latitude, g.longitude).transpose() *
                         Gravity(EcefFromGeodetic(g));
    EXPECT_NEAR(g_n.head<2>().norm(), 0.0, 1e-9);
    EXPECT_NEAR(g_n.z(),
                GeographicLib::NormalGravity::WGS84().SurfaceGravity(latitude),
                1e-10);
  }
}

TEST(Wgs84, GravityExceedsGravitationByTheCentrifugalPart) {
  const Vector3d p_e = EcefFromGeodetic({0.6, 0.4, 1000.0});
  const Vector3d w = EarthRate_e();
  EXPECT_LT((Gravity(p_e) - (Gravitation(p_e) - w.cross(w.cross(p_e)))).norm(),
            2e-15);
}

TEST(Wgs84, GradientMatchesNumericDifference) {
  constexpr double kStep = 100.0;
  for (const Geodetic& g : Places()) {
    const Vector3d p_e = EcefFromGeodetic(g);
    Matrix3d numeric;
    for (int i = 0; i < 3; ++i) {
      const Vector3d d = kStep * Vector3d::Unit(i);
      numeric.col(i) =
          (Gravitation(p_e + d) - Gravitation(p_e - d)) / (2.0 * kStep);
    }
    const Matrix3d gradient = GravitationGradient(p_e);
    EXPECT_LT((gradient - numeric).norm(), 1e-4 * numeric.norm());
    EXPECT_LT((gradient - gradient.transpose()).norm(), 1e-15);
    // Laplace: free of divergence outside the masses.
    EXPECT_LT(std::abs(gradient.trace()), 1e-18);
  }
}

}  // namespace
}  // namespace hindsight
