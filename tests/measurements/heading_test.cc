#include "measurements/heading.h"

#include <gtest/gtest.h>

#include "measurements/numeric_jacobian.h"
#include "measurements/sensor_kind.h"
#include "support/test_motion.h"

namespace hindsight {
namespace {

using testing::ExpectJacobian;
using testing::RichScene;
using testing::Scene;

Measurement HeadingOf(double heading, double pitch, double pitch_sigma) {
  GenericReading z;
  z.model = &BaselineDirection();
  z.value.head<2>() << heading, pitch;
  z.sigma.head<2>() << 0.5 * kDegree, pitch_sigma;
  return {0.0, 0, false, z};
}

TEST(Heading, OfABaselineAcrossTheVehicle) {
  // Heading 100 deg, climbing 10 deg; the baseline lies along the right wing.
  Scene scene;
  scene.state = MakeState(0.0, {0.8, 0.2, 100.0}, {0.0, 0.0, 0.0},
                          {0.0, 10.0 * kDegree, 100.0 * kDegree});
  scene.sensor.own_vector = {0.0, 2.0, 0.0};
  const LinearizedMeasurement along =
      scene.Evaluate(HeadingOf(-169.0 * kDegree, 0.0, 1.0 * kDegree));
  ASSERT_EQ(along.residual.size(), 2);
  EXPECT_NEAR(along.residual(0), 1.0 * kDegree, 1e-12);
  EXPECT_NEAR(along.residual(1), 0.0, 1e-12);
  EXPECT_NEAR(along.R(0, 0), std::pow(0.5 * kDegree, 2), 1e-15);
  scene.sensor.own_vector = {3.0, 0.0, 0.0};
  const LinearizedMeasurement forward =
      scene.Evaluate(HeadingOf(100.0 * kDegree, 12.0 * kDegree, kDegree));
  EXPECT_NEAR(forward.residual(0), 0.0, 1e-12);
  EXPECT_NEAR(forward.residual(1), 2.0 * kDegree, 1e-12);
}

TEST(Heading, WrapsAtAFullTurn) {
  Scene scene;
  scene.state = MakeState(0.0, {0.8, 0.2, 100.0}, {0.0, 0.0, 0.0},
                          {0.0, 0.0, 179.5 * kDegree});
  scene.sensor.own_vector = {1.0, 0.0, 0.0};
  const LinearizedMeasurement z =
      scene.Evaluate(HeadingOf(-179.5 * kDegree, 0.0, 0.0));
  ASSERT_EQ(z.residual.size(), 1);
  EXPECT_NEAR(z.residual(0), 1.0 * kDegree, 1e-12);
}

TEST(Heading, NumericJacobian) {
  Scene scene = RichScene();
  for (const Eigen::Vector3d& baseline :
       {Eigen::Vector3d(1.0, 0.0, 0.0), Eigen::Vector3d(0.2, -1.0, 0.3)}) {
    scene.sensor.own_vector = baseline;
    ExpectJacobian(scene, HeadingOf(0.3, 0.1, 0.02), "heading and pitch");
    ExpectJacobian(scene, HeadingOf(0.3, 0.0, 0.0), "heading alone");
  }
}

}  // namespace
}  // namespace hindsight
