#include "measurements/stationary.h"

#include <gtest/gtest.h>

#include "measurements/numeric_jacobian.h"

namespace hindsight {
namespace {

using testing::ExpectJacobian;
using testing::RichScene;
using testing::Scene;

TEST(ZeroVelocity, ResidualIsMinusTheNedVelocity) {
  Scene scene;
  scene.state = MakeState(0.0, {0.3, 1.0, 10.0}, {0.3, -0.2, 0.1},
                          {0.0, 0.0, 90.0 * kDegree});
  scene.sensor.lever_arm_b = {2.0, 3.0, -1.0};  // a rigid body stands as one
  const LinearizedMeasurement z =
      scene.Evaluate({0.0, 0, false, ZeroVelocity{0.02}});
  EXPECT_LT((z.residual - Eigen::Vector3d(-0.3, 0.2, -0.1)).norm(), 1e-14);
  EXPECT_EQ(z.H.middleCols<3>(3), Eigen::MatrixXd::Identity(3, 3));
  EXPECT_EQ(z.R, RowMatrix(4e-4 * Eigen::Matrix3d::Identity()));
}

TEST(ZeroVelocity, JacobianMatchesNumericDifference) {
  ExpectJacobian(RichScene(), {0.0, 0, false, ZeroVelocity{0.02}},
                 "zero velocity");
}

TEST(ZeroAngularRate, ReadingAtRestIsEarthRateAndBias) {
  Scene scene;
  // Heading east on the equator: north, where the Earth's axis points, is left.
  scene.state =
      MakeState(0.0, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {0, 0, 90.0 * kDegree});
  scene.state.b_g = {1e-3, 2e-3, 3e-3};
  const Eigen::Vector3d reading =
      Eigen::Vector3d(0.0, -kEarthRate, 0.0) + scene.state.b_g;
  const LinearizedMeasurement z =
      scene.Evaluate({0.0, 0, false, ZeroAngularRate{reading, 1e-4}});
  EXPECT_LT(z.residual.norm(), 1e-17);
  EXPECT_EQ(z.H.middleCols<3>(9), Eigen::MatrixXd::Identity(3, 3));
  // Turning right by psi, the axis falls behind: forward reading -w_ie psi.
  EXPECT_LT((z.H.col(8) - Eigen::Vector3d(-kEarthRate, 0.0, 0.0)).norm(),
            1e-17);
}

TEST(ZeroAngularRate, JacobianMatchesNumericDifference) {
  // Steps of 1e-4 give a resolution of 1e-15/1e-4: the Earth rate is seen.
  const Scene scene = RichScene();
  const Measurement z{
      0.0, 0, false, ZeroAngularRate{Eigen::Vector3d(1e-3, 2e-3, -1e-3), 1e-4}};
  const LinearizedMeasurement at = scene.Evaluate(z);
  for (int c = 3; c < scene.layout.dim(); ++c) {
    ErrorVector step = ErrorVector::Zero(scene.layout.dim());
    step(c) = 1e-4;
    const RowVector numeric =
        (scene.EvaluateAt(z, Retract(scene.layout, scene.state, -step))
             .residual -
         scene.EvaluateAt(z, Retract(scene.layout, scene.state, step))
             .residual) /
        2e-4;
    EXPECT_LT((numeric - at.H.col(c)).norm(), 1e-10)
        << scene.layout.ComponentName(c);
  }
}

}  // namespace
}  // namespace hindsight
