#include "state/error_definition.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "state/random_error.h"

namespace hindsight {
namespace {

using testing::RandomError;

constexpr ErrorDefinition kAll[] = {ErrorDefinition::kNavigation,
                                    ErrorDefinition::kQuaternion,
                                    ErrorDefinition::kLeftInvariant};

ErrorLayout LayoutWithoutPosition() {
  ErrorLayout layout;
  const ErrorLayout all = NavigationLayout({});
  for (const Block& block : all.blocks()) {
    if (block.key.kind != BlockKind::kPosition) layout.Add(block);
  }
  return layout;
}

State TypicalState() {
  State x = MakeState(0.0, {37.0 * kDegree, 127.0 * kDegree, 50.0},
                      {12.0, -7.0, 0.5}, {0.1, -0.2, 2.1});
  x.b_g = {1e-3, -2e-3, 1.5e-3};
  return x;
}

/// d Local(to, Retract(from, d)) / d d by differences.
ErrorMatrix NumericTransport(ErrorDefinition error, const ErrorLayout& layout,
                             const State& from, const ErrorVector& d,
                             const State& to) {
  constexpr double kStep = 1e-5;
  ErrorMatrix T(layout.dim(), layout.dim());
  for (int j = 0; j < layout.dim(); ++j) {
    ErrorVector step = ErrorVector::Zero(layout.dim());
    step(j) = kStep;
    T.col(j) = (Local(layout, to, Retract(error, layout, from, d + step)) -
                Local(layout, to, Retract(error, layout, from, d - step))) /
               (2.0 * kStep);
  }
  return T;
}

TEST(ErrorDefinition, AllAreTheCanonicalTangentToFirstOrder) {
  const ErrorLayout layout = NavigationLayout({});
  Random random(1);
  for (const ErrorDefinition error : kAll) {
    const ErrorVector d = RandomError(layout, &random, 1e-4);
    const State x = TypicalState();
    // The second order of 1e-4 is 1e-8; positions round to 1e-9 m.
    EXPECT_LT((Local(layout, x, Retract(error, layout, x, d)) - d)
                  .cwiseAbs()
                  .maxCoeff(),
              5e-8);
    EXPECT_LT((Local(error, layout, x, Retract(layout, x, d)) - d)
                  .cwiseAbs()
                  .maxCoeff(),
              5e-8);
  }
}

TEST(ErrorDefinition, LocalInvertsRetract) {
  const ErrorLayout layout = LayoutWithoutPosition();
  Random random(2);
  const State x = TypicalState();
  for (int i = 0; i < 20; ++i) {
    ErrorVector d = RandomError(layout, &random, 0.8);
    for (const ErrorDefinition error :
         {ErrorDefinition::kNavigation, ErrorDefinition::kLeftInvariant}) {
      const State y = Retract(error, layout, x, d);
      EXPECT_LT((Local(error, layout, x, y) - d).cwiseAbs().maxCoeff(), 1e-9);
    }
    // 2 tan(a/2) leads there, 2 sin(a/2) is the distance: q - q^ has a part
    // along q^.
    const State y = Retract(ErrorDefinition::kQuaternion, layout, x, d);
    const double a = x.q_eb.angularDistance(y.q_eb);
    EXPECT_NEAR(d.segment<3>(3).norm(), 2.0 * std::tan(0.5 * a), 1e-9);
    EXPECT_NEAR(
        Local(ErrorDefinition::kQuaternion, layout, x, y).segment<3>(3).norm(),
        2.0 * std::sin(0.5 * a), 1e-9);
  }
}

TEST(ErrorDefinition, LeftInvariantErrorIsTheGroupsExponential) {
  // X = [C v; 0 1]: Exp([phi nu]) by its series, in body axes.
  const ErrorLayout layout = LayoutWithoutPosition();
  Random random(3);
  const State x = TypicalState();
  const ErrorVector d = RandomError(layout, &random, 0.7);
  const Eigen::Matrix3d C_bn = x.q_eb.toRotationMatrix().transpose() * x.C_en();
  Eigen::Matrix4d generator = Eigen::Matrix4d::Zero();
  generator.topLeftCorner<3, 3>() = Skew(C_bn * d.segment<3>(3));
  generator.topRightCorner<3, 1>() = C_bn * d.head<3>();
  Eigen::Matrix4d exponential = Eigen::Matrix4d::Identity();
  Eigen::Matrix4d term = Eigen::Matrix4d::Identity();
  for (int i = 1; i < 40; ++i) {
    term = (term * generator / i).eval();
    exponential += term;
  }
  Eigen::Matrix4d X = Eigen::Matrix4d::Identity();
  X.topLeftCorner<3, 3>() = x.q_eb.toRotationMatrix();
  X.topRightCorner<3, 1>() = x.v_e;
  const Eigen::Matrix4d expected = X * exponential;
  const State y = Retract(ErrorDefinition::kLeftInvariant, layout, x, d);
  EXPECT_LT((y.q_eb.toRotationMatrix() - expected.topLeftCorner<3, 3>())
                .cwiseAbs()
                .maxCoeff(),
            1e-12);
  EXPECT_LT((y.v_e - expected.topRightCorner<3, 1>()).norm(), 1e-12);
}

TEST(ErrorDefinition, TransportIsTheDerivativeOfRetract) {
  const ErrorLayout layout = LayoutWithoutPosition();
  Random random(4);
  const State x = TypicalState();
  const ErrorVector d = RandomError(layout, &random, 0.5);
  for (const ErrorDefinition error :
       {ErrorDefinition::kNavigation, ErrorDefinition::kQuaternion}) {
    const State y = Retract(error, layout, x, d);
    const ErrorMatrix T = Transport(error, layout, x, d, y);
    EXPECT_LT(
        (T - NumericTransport(error, layout, x, d, y)).cwiseAbs().maxCoeff(),
        1e-8)
        << ErrorName(error);
  }
}

TEST(ErrorDefinition, LeftInvariantResetLeavesTheBodyAxesCovariance) {
  const ErrorLayout layout = LayoutWithoutPosition();
  Random random(5);
  const State x = TypicalState();
  const ErrorVector d = RandomError(layout, &random, 0.5);
  const State y = Retract(ErrorDefinition::kLeftInvariant, layout, x, d);
  const auto to_body = [&](const State& s) {
    ErrorMatrix J = ErrorMatrix::Identity(layout.dim(), layout.dim());
    const Eigen::Matrix3d C_bn =
        s.q_eb.toRotationMatrix().transpose() * s.C_en();
    J.block<3, 3>(0, 0) = C_bn;
    J.block<3, 3>(3, 3) = C_bn;
    return J;
  };
  const ErrorMatrix T =
      Transport(ErrorDefinition::kLeftInvariant, layout, x, d, y);
  const ErrorMatrix in_body = to_body(y) * T * to_body(x).transpose();
  EXPECT_LT((in_body - ErrorMatrix::Identity(layout.dim(), layout.dim()))
                .cwiseAbs()
                .maxCoeff(),
            1e-12);
}

TEST(ErrorDefinition, QuaternionCovarianceGoesThroughTheNormalisation) {
  // The same reset in the four components of dq, x y z w.
  const ErrorLayout layout = LayoutWithoutPosition();
  Random random(6);
  const State x = TypicalState();
  const ErrorVector d = RandomError(layout, &random, 0.6);
  const State y = Retract(ErrorDefinition::kQuaternion, layout, x, d);
  const Eigen::Matrix<double, 4, 3> G_x = LeftPlusJacobian(x.q_eb) * x.C_en();
  const Eigen::Matrix<double, 4, 3> G_y = LeftPlusJacobian(y.q_eb) * y.C_en();
  const Eigen::Vector4d sum = x.q_eb.coeffs() + G_x * d.segment<3>(3);
  const Eigen::Vector4d q = sum.normalized();
  EXPECT_LT((q - y.q_eb.coeffs()).norm(), 1e-12);
  const Eigen::Matrix4d N =
      (Eigen::Matrix4d::Identity() - q * q.transpose()) / sum.norm();
  Eigen::Matrix3d A;
  for (double& value : A.reshaped()) value = random.Normal();
  const Eigen::Matrix3d P = A * A.transpose();
  const Eigen::Matrix4d P_q = N * G_x * P * G_x.transpose() * N.transpose();
  const Eigen::Matrix3d T =
      Transport(ErrorDefinition::kQuaternion, layout, x, d, y)
          .block<3, 3>(3, 3);
  EXPECT_LT((G_y * T * P * T.transpose() * G_y.transpose() - P_q)
                .cwiseAbs()
                .maxCoeff(),
            1e-12);
}

TEST(ErrorDefinition, NamesReadBackAndOthersAreRefused) {
  for (const ErrorDefinition error : kAll) {
    EXPECT_EQ(ErrorFromName(ErrorName(error)), error);
  }
  EXPECT_THROW(ErrorFromName("right_invariant"), InputError);
}

}  // namespace
}  // namespace hindsight
