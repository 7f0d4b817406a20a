#include "geometry/so3.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "base/random.h"
#include "base/units.h"

namespace hindsight {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Rotation vectors of lengths on both sides of every series' threshold, up to
/// just below pi.
std::vector<Vector3d> RotationVectors() {
  Random random(7);
  std::vector<Vector3d> vectors;
  for (const double angle :
       {1e-12, 1e-8, 1e-6, 0.999e-3, 1.001e-3, 0.999e-2, 1.001e-2, 0.0999,
        0.1001, 0.5, 1.5, 3.0, kPi - 1e-6}) {
    for (int i = 0; i < 4; ++i) {
      vectors.emplace_back(angle * random.NormalVector3().normalized());
    }
  }
  return vectors;
}

double AngleBetween(const Quaterniond& a, const Quaterniond& b) {
  return 2.0 * (a * b.conjugate()).vec().norm();
}

TEST(So3, ExpEqualsAngleAxis) {
  for (const Vector3d& v : RotationVectors()) {
    const Quaterniond expected(Eigen::AngleAxisd(v.norm(), v.normalized()));
    EXPECT_LT((Exp(v).coeffs() - expected.coeffs()).norm(), 4e-16) << v.norm();
  }
  EXPECT_EQ(Exp(Vector3d::Zero()).coeffs(), Quaterniond::Identity().coeffs());
}

TEST(So3, ExpOfMoreThanATurnWraps) {
  const Vector3d axis = Vector3d(1.0, -2.0, 0.5).normalized();
  EXPECT_LT(AngleBetween(Exp((2.0 * kPi + 0.3) * axis), Exp(0.3 * axis)),
            1e-14);
}

TEST(So3, LogInvertsExp) {
  for (const Vector3d& v : RotationVectors()) {
    EXPECT_LT((Log(Exp(v)) - v).norm(), 2e-15 * (1.0 + v.norm())) << v.norm();
    // Relative accuracy of small rotations matters to the IMU's noise.
    EXPECT_LT((Log(Exp(v)) - v).norm(), 4e-15 * v.norm()) << v.norm();
  }
}

TEST(So3, LogIgnoresSignAndScaleOfTheQuaternion) {
  for (const Vector3d& v : RotationVectors()) {
    Quaterniond q = Exp(v);
    q.coeffs() *= -1.0;
    EXPECT_LT((Log(q) - v).norm(), 1e-14);
    q.coeffs() *= 1.001;
    EXPECT_LT((Log(q) - v).norm(), 1e-14);
  }
}

TEST(So3, LogOfHalfATurnHasLengthPi) {
  const Quaterniond q(0.0, 0.6, 0.0, 0.8);
  EXPECT_LT((Log(q) - kPi * Vector3d(0.6, 0.0, 0.8)).norm(), 1e-15);
}

TEST(So3, SkewIsTheCrossProduct) {
  const Vector3d v(1.0, 2.0, 3.0);
  const Vector3d u(-4.0, 0.5, 6.0);
  EXPECT_EQ(Skew(v) * u, v.cross(u));
}

/// Central difference of Log(Exp(v)^-1 Exp(v + d)) for the right Jacobian.
Matrix3d NumericRightJacobian(const Vector3d& v) {
  constexpr double kStep = 1e-5;
  Matrix3d J;
  for (int i = 0; i < 3; ++i) {
    const Vector3d d = kStep * Vector3d::Unit(i);
    J.col(i) = (Log(Exp(v).conjugate() * Exp(v + d)) -
                Log(Exp(v).conjugate() * Exp(v - d))) /
               (2.0 * kStep);
  }
  return J;
}

TEST(So3, JacobiansMatchNumericDifference) {
  // Truncation step^2 / 6, rounding eps / step: both below 5e-11.
  for (const Vector3d& v : RotationVectors()) {
    const Matrix3d J = NumericRightJacobian(v);
    EXPECT_LT((RightJacobian(v) - J).norm(), 2e-10) << v.norm();
    EXPECT_LT((LeftJacobian(v) - Exp(v).toRotationMatrix() * J).norm(), 2e-10)
        << v.norm();
  }
}

TEST(So3, InverseJacobiansAreInverses) {
  for (const Vector3d& v : RotationVectors()) {
    EXPECT_LT(
        (RightJacobian(v) * RightJacobianInverse(v) - Matrix3d::Identity())
            .norm(),
        2e-12)
        << v.norm();
    EXPECT_LT((LeftJacobian(v) * LeftJacobianInverse(v) - Matrix3d::Identity())
                  .norm(),
              2e-12)
        << v.norm();
  }
}

TEST(So3, LeftPlusJacobianMatchesNumericDifference) {
  constexpr double kStep = 1e-5;
  const Quaterniond q = Exp(Vector3d(0.4, -1.2, 2.0));
  const Eigen::Matrix<double, 4, 3> J = LeftPlusJacobian(q);
  for (int i = 0; i < 3; ++i) {
    const Vector3d d = kStep * Vector3d::Unit(i);
    const Eigen::Vector4d numeric =
        ((Exp(d) * q).coeffs() - (Exp(-d) * q).coeffs()) / (2.0 * kStep);
    EXPECT_LT((J.col(i) - numeric).norm(), 1e-10);
  }
}

TEST(So3, EulerConventionByHand) {
  // Heading 90 deg: forward points east, right points south.
  const Matrix3d turned =
      QuaternionFromEuler(0.0, 0.0, kPi / 2).toRotationMatrix();
  EXPECT_LT((turned * Vector3d::UnitX() - Vector3d::UnitY()).norm(), 1e-15);
  EXPECT_LT((turned * Vector3d::UnitY() + Vector3d::UnitX()).norm(), 1e-15);
  // Pitch 30 deg: forward points up.
  const Vector3d nose =
      QuaternionFromEuler(0.0, kPi / 6, 0.0) * Vector3d::UnitX();
  EXPECT_LT((nose - Vector3d(std::sqrt(0.75), 0.0, -0.5)).norm(), 1e-15);
  // Roll 90 deg: the right side points down.
  const Vector3d right =
      QuaternionFromEuler(kPi / 2, 0.0, 0.0) * Vector3d::UnitY();
  EXPECT_LT((right - Vector3d::UnitZ()).norm(), 1e-15);
  // All three: the nose depends on pitch and heading only.
  const Vector3d all =
      QuaternionFromEuler(1.0, kPi / 6, kPi / 2) * Vector3d::UnitX();
  EXPECT_LT((all - Vector3d(0.0, std::sqrt(0.75), -0.5)).norm(), 1e-15);
}

TEST(So3, EulerRoundTrip) {
  for (const double roll : {-3.0, -0.2, 0.0, 1.0, kPi}) {
    for (const double pitch : {-1.57, -0.5, 0.0, 1.2, 1.57}) {
      for (const double heading : {-3.1, -kPi / 2, 0.0, 2.0, kPi}) {
        const Vector3d euler =
            EulerFromQuaternion(QuaternionFromEuler(roll, pitch, heading));
        // At 1.57 rad the horizontal part of the nose is 8e-4: 1/8e-4 more
        // rounding.
        EXPECT_NEAR(WrapAngle(euler.x() - roll), 0.0, 2e-12);
        EXPECT_NEAR(euler.y(), pitch, 1e-14);
        EXPECT_NEAR(WrapAngle(euler.z() - heading), 0.0, 2e-12);
      }
    }
  }
}

TEST(So3, EulerAtTheZenithKeepsTheAttitude) {
  for (const double pitch : {kPi / 2, -kPi / 2}) {
    const Quaterniond q = QuaternionFromEuler(0.3, pitch, 1.1);
    const Vector3d euler = EulerFromQuaternion(q);
    EXPECT_EQ(euler.x(), 0.0);
    EXPECT_NEAR(euler.y(), pitch, 1e-12);
    EXPECT_LT(
        AngleBetween(QuaternionFromEuler(euler.x(), euler.y(), euler.z()), q),
        1e-12);
  }
}

TEST(So3, WrapAngleIsHalfOpen) {
  EXPECT_EQ(WrapAngle(kPi), kPi);
  EXPECT_EQ(WrapAngle(-kPi), kPi);
  EXPECT_NEAR(WrapAngle(3.0 * kPi / 2.0), -kPi / 2.0, 1e-15);
  EXPECT_NEAR(WrapAngle(-7.0), 2.0 * kPi - 7.0, 1e-15);
  EXPECT_NEAR(WrapAngle(100.0 * 2.0 * kPi + 0.25), 0.25, 1e-13);
}

}  // namespace
}  // namespace hindsight
