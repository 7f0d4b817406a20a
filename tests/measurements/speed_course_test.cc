#include "measurements/speed_course.h"

#include <gtest/gtest.h>

#include "measurements/numeric_jacobian.h"
#include "support/test_motion.h"

namespace hindsight {
namespace {

using testing::ExpectJacobian;
using testing::Scene;

/// Standing at the origin but for a velocity north and east.
Scene Moving(double north, double east) {
  Scene scene;
  scene.state = MakeState(0.0, {0.8, 0.2, 100.0}, {north, east, 0.0},
                          {0.0, 0.0, 30.0 * kDegree});
  return scene;
}

Measurement SpeedAlone(double speed) {
  return {0.0, 0, false,
          SpeedCourse{.speed = speed, .sigma_speed = 0.2, .has_course = false}};
}

TEST(SpeedCourse, AloneIsTheLengthOfTheVelocity) {
  const Scene scene = Moving(0.9, -1.2);
  const LinearizedMeasurement at = scene.Evaluate(SpeedAlone(2.0));
  ASSERT_EQ(at.residual.size(), 1);
  EXPECT_NEAR(at.residual(0), 0.5, 1e-12);
  ExpectJacobian(scene, SpeedAlone(2.0), "1.5 m/s");
}

TEST(SpeedCourse, AloneHasADerivativeWhereTheVelocityIsNearZero) {
  ExpectJacobian(Moving(0.1, 0.05), SpeedAlone(1.0), "0.6 sigma");
  ExpectJacobian(Moving(0.0, 0.0), SpeedAlone(1.0), "standstill");
  const double below =
      Moving(0.2 - 1e-9, 0.0).Evaluate(SpeedAlone(1.0)).residual(0);
  const double above =
      Moving(0.2 + 1e-9, 0.0).Evaluate(SpeedAlone(1.0)).residual(0);
  EXPECT_NEAR(below, above, 1e-8);
}

}  // namespace
}  // namespace hindsight
