#include "filters/kalman.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"

namespace hindsight {
namespace {

struct Case {
  ErrorVector dx;
  ErrorMatrix P;
  LinearizedMeasurement z;
};

/// n states and `rows` rows of full random matrices.
Case RandomCase(int n, int rows, Random* random) {
  const auto matrix = [&](int r, int c) {
    Eigen::MatrixXd M(r, c);
    for (int j = 0; j < c; ++j) {
      for (int i = 0; i < r; ++i) M(i, j) = random->Normal();
    }
    return M;
  };
  Case c;
  c.dx = matrix(n, 1);
  const Eigen::MatrixXd A = matrix(n, n);
  c.P = A * A.transpose() + Eigen::MatrixXd::Identity(n, n);
  const Eigen::MatrixXd B = matrix(rows, rows);
  c.z.Resize(rows, n);
  c.z.R = B * B.transpose() + Eigen::MatrixXd::Identity(rows, rows);
  c.z.H = matrix(rows, n);
  c.z.residual = matrix(rows, 1);
  return c;
}

TEST(Kalman, UpdateEqualsTheInformationForm) {
  Random random(1);
  for (const int rows : {1, 2, 3, 6}) {
    Case c = RandomCase(15, rows, &random);
    // P+^-1 = P^-1 + H' R^-1 H,  P+^-1 x+ = P^-1 x + H' R^-1 z.
    const Eigen::MatrixXd P_inverse = c.P.inverse();
    const Eigen::MatrixXd R_inverse = c.z.R.inverse();
    const Eigen::MatrixXd P =
        (P_inverse + c.z.H.transpose() * R_inverse * c.z.H).inverse();
    const Eigen::VectorXd x =
        P * (P_inverse * c.dx + c.z.H.transpose() * R_inverse * c.z.residual);
    Update(c.z, Innovate(c.z, c.dx, c.P), &c.dx, &c.P);
    // Condition numbers below 1e4.
    EXPECT_LT((c.P - P).norm(), 1e-10 * P.norm()) << rows;
    EXPECT_LT((c.dx - x).norm(), 1e-10 * x.norm()) << rows;
  }
}

TEST(Kalman, InnovationOfOneRowByHand) {
  LinearizedMeasurement z;
  z.Resize(1, 2);
  z.residual << 5.0;
  z.H << 1.0, 2.0;
  z.R << 0.5;
  const ErrorVector dx = Eigen::Vector2d(1.0, 1.0);
  ErrorMatrix P(2, 2);
  P << 2.0, 0.5, 0.5, 1.0;
  const Innovation innovation = Innovate(z, dx, P);
  // S = 2 + 2 * 2 * 0.5 + 4 * 1 + 0.5, innovation 5 - 3.
  EXPECT_DOUBLE_EQ(innovation.S(0, 0), 8.5);
  EXPECT_DOUBLE_EQ(innovation.residual(0), 2.0);
  EXPECT_DOUBLE_EQ(innovation.nis, 4.0 / 8.5);
  EXPECT_DOUBLE_EQ(innovation.log_likelihood,
                   -0.5 * (4.0 / 8.5 + std::log(8.5 * 2.0 * kPi)));
}

TEST(Kalman, CovarianceStaysSymmetricAndPositiveUnderSharpUpdates) {
  // A prior of 1 km against a fix of 1 mm: (I - K H) P alone loses definiteness
  // at 1e-12 of the prior.
  Random random(2);
  ErrorMatrix P = 1e6 * ErrorMatrix::Identity(3, 3);
  ErrorVector dx = ErrorVector::Zero(3);
  for (int i = 0; i < 50; ++i) {
    Case c = RandomCase(3, 2, &random);
    c.z.R *= 1e-6;
    Update(c.z, Innovate(c.z, dx, P), &dx, &P);
    EXPECT_EQ(P, ErrorMatrix(P.transpose()));
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(P);
    EXPECT_GT(eigen.eigenvalues().minCoeff(), 0.0) << i;
  }
}

TEST(Kalman, PredictionIsSymmetricToTheLastBit) {
  Random random(3);
  const Case c = RandomCase(15, 3, &random);
  const Case q = RandomCase(15, 3, &random);
  Eigen::MatrixXd Phi = Eigen::MatrixXd::Identity(15, 15);
  Phi.topRightCorner(3, 3).setConstant(0.3);
  ErrorMatrix P = c.P;
  PredictCovariance(Phi, q.P, &P);
  EXPECT_EQ(P, ErrorMatrix(P.transpose()));
  const Eigen::MatrixXd expected = Phi * c.P * Phi.transpose() + q.P;
  EXPECT_LT((P - expected).norm(), 1e-14 * expected.norm());
}

TEST(Kalman, IndefiniteInnovationIsAnError) {
  Random random(4);
  Case c = RandomCase(4, 2, &random);
  c.z.R = -1e3 * RowMatrix::Identity(2, 2);
  EXPECT_THROW(Innovate(c.z, c.dx, c.P), EstimationError);
}

}  // namespace
}  // namespace hindsight
