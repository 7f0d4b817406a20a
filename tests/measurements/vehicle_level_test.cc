#include "measurements/vehicle_level.h"

#include <gtest/gtest.h>

#include "measurements/numeric_jacobian.h"

namespace hindsight {
namespace {

using testing::Scene;

TEST(VehicleLevel, ResidualIsTheSineOfTheRoll) {
  Scene scene;
  scene.sensor.vehicle = 0;
  scene.state =
      MakeState(0.0, {0.8, 0.2, 100.0}, {5.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  const Measurement z{0.0, 0, false, VehicleLevel{0.1}};
  EXPECT_NEAR(scene.Evaluate(z).residual(0), 0.0, 1e-15);
  // The vehicle leans to the right by 0.2 rad against a level IMU.
  scene.sensor.q_sb = Exp(Eigen::Vector3d(0.2, 0.0, 0.0)).conjugate();
  EXPECT_NEAR(scene.Evaluate(z).residual(0), -std::sin(0.2), 1e-15);
  EXPECT_NEAR(scene.Evaluate(z).R(0, 0), 0.01, 1e-15);
}

TEST(VehicleLevel, JacobianMatchesNumericDifference) {
  Scene scene = testing::RichScene();
  scene.sensor.vehicle = 0;
  ExpectJacobian(scene, {0.0, 0, false, VehicleLevel{0.1}}, "level");
}

TEST(VehicleLevel, IsNoNoiseToBeFitted) {
  Measurement z{0.0, 0, false, VehicleLevel{0.1}};
  ScaleSigma(3.0, &z);
  EXPECT_EQ(std::get<VehicleLevel>(z.model).sigma, 0.1);
}

}  // namespace
}  // namespace hindsight
