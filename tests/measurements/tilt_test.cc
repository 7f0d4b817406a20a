#include "measurements/tilt.h"

#include <gtest/gtest.h>

#include "measurements/numeric_jacobian.h"

namespace hindsight {
namespace {

using testing::Scene;

TEST(Tilt, OfALevelBodyPointsUpwards) {
  Scene scene;
  scene.state =
      MakeState(0.0, {0.8, 0.2, 100.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  const Tilt level{{0.0, 0.0, -9.8}, 9.8, 0.2};
  const LinearizedMeasurement z = scene.Evaluate({0.0, 0, false, level});
  EXPECT_LT(z.residual.norm(), 1e-14);
  EXPECT_NEAR(z.R(1, 1), 0.04, 1e-15);
  // Rolled to the right by 0.1 rad, the body feels the ground push to its left.
  const double s = std::sin(0.1);
  scene.state =
      MakeState(0.0, {0.8, 0.2, 100.0}, {0.0, 0.0, 0.0}, {0.1, 0.0, 1.0});
  EXPECT_NEAR(scene.Evaluate({0.0, 0, false, level}).residual.y(), 9.8 * s,
              1e-14);
}

TEST(Tilt, JacobianMatchesNumericDifference) {
  const Scene scene = testing::RichScene();
  ExpectJacobian(scene, {0.0, 0, false, Tilt{{0.3, -1.1, -9.6}, 9.81, 0.3}},
                 "tilt");
}

/// Resolved in n, the rows that do not depend on the body's attitude.
TEST(Tilt, SaysNothingOfHeading) {
  Scene scene;
  const LinearizedMeasurement z =
      scene.Evaluate({0.0, 0, false, Tilt{{0.3, -1.1, -9.6}, 9.81, 0.3}});
  const Block& psi = *scene.layout.Find(BlockKind::kAttitude);
  EXPECT_LT(z.H.col(psi.offset + 2).norm(), 1e-14);
  EXPECT_NEAR(z.H.col(psi.offset).norm(), 9.81, 1e-12);
}

}  // namespace
}  // namespace hindsight
