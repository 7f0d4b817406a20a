#include "state/euler_error.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "base/random.h"

namespace hindsight {
namespace {

TEST(EulerErrorJacobian, MatchesNumericDifference) {
  const Eigen::Vector3d euler(0.3, -0.7, 2.1);
  const Eigen::Quaterniond q =
      QuaternionFromEuler(euler.x(), euler.y(), euler.z());
  const Eigen::Matrix3d J = EulerErrorJacobian(euler);
  constexpr double step = 1e-6;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d psi = step * Eigen::Vector3d::Unit(i);
    const Eigen::Vector3d column = (EulerFromQuaternion(Exp(psi) * q) -
                                    EulerFromQuaternion(Exp(-psi) * q)) /
                                   (2.0 * step);
    EXPECT_LT((J.col(i) - column).norm(), 1e-8) << "axis " << i;
  }
}

/// A navigation-grade attitude beside a poor position, correlated with it, at
/// large roll and pitch.
struct PoorPosition {
  ErrorLayout layout = NavigationLayout({});
  State x =
      MakeState(0.0, {1.1, 0.3, 200.0}, {1.0, 2.0, 0.0}, {2.4, -1.3, 0.8});
  ErrorMatrix P = ErrorMatrix::Identity(15, 15);

  PoorPosition() {
    ErrorMatrix half = ErrorMatrix::Zero(15, 15);
    Random random(7);
    constexpr double kSigma[] = {400.0, 1.0, 1e-4, 1e-8, 1e-4};
    for (int i = 0; i < 15; ++i) {
      for (int j = 0; j < 15; ++j) {
        half(i, j) = kSigma[i / 3] * (random.Normal() + (i == j ? 2.0 : 0.0));
      }
    }
    P = half * half.transpose();
  }
};

TEST(EulerSigma, IsThatOfTheAnglesByNumericDifference) {
  const PoorPosition poor;
  Eigen::Matrix<double, 3, Eigen::Dynamic> J(3, 15);
  for (int i = 0; i < 15; ++i) {
    ErrorVector d = ErrorVector::Zero(15);
    const double step = i < 3 ? 10.0 : 1e-6;
    d(i) = step;
    const Eigen::Vector3d ahead = Retract(poor.layout, poor.x, d).euler();
    d(i) = -step;
    J.col(i) = (ahead - Retract(poor.layout, poor.x, d).euler()) / (2.0 * step);
  }
  const Eigen::Vector3d expected =
      (J * poor.P * J.transpose()).diagonal().cwiseSqrt();
  const Eigen::Vector3d sigma = EulerSigma(poor.layout, poor.x, poor.P);
  EXPECT_LT((sigma - expected).cwiseQuotient(expected).norm(), 1e-5);
  // That of the rotation alone is another figure.
  const Eigen::Vector3d tangent =
      EulerSigma(poor.x.euler(), poor.P.block<3, 3>(6, 6));
  EXPECT_GT((tangent - expected).cwiseQuotient(expected).cwiseAbs().maxCoeff(),
            0.02);
}

TEST(EulerSigma, IsThatOfTheAnglesByMonteCarlo) {
  constexpr int kRuns = 20000;
  const PoorPosition poor;
  const Eigen::LLT<ErrorMatrix> llt(poor.P);
  const Eigen::Vector3d euler = poor.x.euler();
  Random random(11);
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (int run = 0; run < kRuns; ++run) {
    ErrorVector u(15);
    for (int i = 0; i < 15; ++i) u(i) = random.Normal();
    const ErrorVector d = llt.matrixL() * u;
    sum += (Retract(poor.layout, poor.x, d).euler() - euler).array().square();
  }
  const Eigen::Array3d ratio =
      sum / kRuns / EulerSigma(poor.layout, poor.x, poor.P).array().square();
  // Four sigmas of the variance of a sample.
  const double spread = 4.0 * std::sqrt(2.0 / kRuns);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(ratio(i), 1.0, spread) << i;
}

TEST(EulerSigma, IsBoundedAtTheVertical) {
  const Eigen::Matrix3d P = Eigen::Matrix3d::Identity() * kDegree * kDegree;
  for (const double pitch : {0.5 * kPi, 0.5 * kPi - 1e-9, -0.5 * kPi}) {
    const Eigen::Vector3d sigma =
        EulerSigma(Eigen::Vector3d(0.2, pitch, 1.0), P);
    EXPECT_DOUBLE_EQ(sigma.x(), kUnknownAngleSigma);
    EXPECT_NEAR(sigma.y(), kDegree, 1e-12);
    EXPECT_DOUBLE_EQ(sigma.z(), kUnknownAngleSigma);
  }
}

}  // namespace
}  // namespace hindsight
