#include "earth/utm.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"

namespace hindsight {
namespace {

struct Known {
  double latitude, longitude;  ///< deg
  UtmZone zone;
  double easting, northing;  ///< m
};

/// By Krueger's series to the third power of n (Karney 2011, eqs. 7 to 9 and 35),
/// good to a millimetre.
TEST(Utm, PlacesAreThoseOfKruegersSeries) {
  for (const Known& known :
       {Known{48.0, 11.5, {32, true}, 686482.6351, 5319324.5637},
        Known{35.0, 129.3, {52, true}, 527375.5395, 3873084.1724},
        Known{-35.0, 129.3, {52, false}, 527375.5395, 1e7 - 3873084.1724}}) {
    const Geodetic place = {known.latitude * kDegree, known.longitude * kDegree,
                            120.0};
    const Eigen::Vector3d p = UtmFromGeodetic(place, known.zone);
    EXPECT_NEAR(p.x(), known.easting, 2e-3);
    EXPECT_NEAR(p.y(), known.northing, 2e-3);
    EXPECT_EQ(p.z(), 120.0);
    const Geodetic back = GeodeticFromUtm(p, known.zone);
    EXPECT_NEAR(back.latitude, place.latitude, 1e-14);
    EXPECT_NEAR(back.longitude, place.longitude, 1e-14);
  }
}

/// A metre along each axis is a metre of the projection, but for its scale.
TEST(Utm, AxesAreThoseOfTheGrid) {
  const UtmZone zone = {32, true};
  const Geodetic place = {48.0 * kDegree, 11.5 * kDegree, 500.0};
  const LocalFrame axes = UtmAxesAt(place, zone);
  const Eigen::Vector3d p = UtmFromGeodetic(place, zone);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d step =
        UtmFromGeodetic(GeodeticFromEcef(axes.origin_e + axes.C_el.col(i)),
                        zone) -
        p;
    EXPECT_LT((step - Eigen::Vector3d::Unit(i)).norm(), 1e-3) << i;
  }
  EXPECT_GT(std::abs(axes.C_el.col(1).dot(NedAxes(axes.origin_e).col(1))),
            0.03);
}

}  // namespace
}  // namespace hindsight
