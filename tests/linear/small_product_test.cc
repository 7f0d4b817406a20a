#include "linear/small_product.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

namespace hindsight {
namespace {

class SmallProduct : public ::testing::TestWithParam<int> {};

TEST_P(SmallProduct, IsTheGeneralOne) {
  const int n = GetParam();
  for (const int columns : {1, 2, n}) {
    const Eigen::MatrixXd A = Eigen::MatrixXd::Random(n, n + 1);
    const Eigen::MatrixXd B = Eigen::MatrixXd::Random(n + 1, columns);
    Eigen::MatrixXd out;
    Multiply(A, B, /*lower=*/false, &out);
    EXPECT_LT((out - A * B).norm(), 1e-13 * n) << columns;
    const Eigen::MatrixXd B_transposed = B.transpose();
    Multiply(A, B_transposed.transpose(), /*lower=*/false, &out);
    EXPECT_LT((out - A * B).norm(), 1e-13 * n) << columns;
  }
}

TEST_P(SmallProduct, OfASymmetricOneHasTheLowerHalf) {
  const int n = GetParam();
  const Eigen::MatrixXd A = Eigen::MatrixXd::Random(n, n);
  Eigen::MatrixXd out;
  Multiply(A, A.transpose(), /*lower=*/true, &out);
  const Eigen::MatrixXd difference = out - A * A.transpose();
  EXPECT_LT(Eigen::MatrixXd(difference.triangularView<Eigen::Lower>()).norm(),
            1e-13 * n);
}

TEST_P(SmallProduct, IsAddedAndSubtracted) {
  const int n = GetParam();
  for (const int columns : {1, 2, n}) {
    const Eigen::MatrixXd A = Eigen::MatrixXd::Random(n, 3);
    const Eigen::MatrixXd B = Eigen::MatrixXd::Random(3, columns);
    const Eigen::MatrixXd X = Eigen::MatrixXd::Random(n + 2, columns + 1);
    Eigen::MatrixXd out = X;
    auto part = out.block(1, 1, n, columns);
    AddProduct<1>(A, B, &part);
    Eigen::MatrixXd expected = X;
    expected.block(1, 1, n, columns) += A * B;
    EXPECT_LT((out - expected).norm(), 1e-14 * n) << columns;
    const Eigen::MatrixXd B_transposed = B.transpose();
    AddProduct<-1>(A, B_transposed.transpose(), &part);
    EXPECT_LT((out - X).norm(), 1e-14 * n) << columns;
  }
}

TEST_P(SmallProduct, IsDividedByACholeskyFactor) {
  const int n = GetParam();
  const Eigen::MatrixXd A = Eigen::MatrixXd::Random(n, n);
  const Eigen::MatrixXd S = A * A.transpose() + Eigen::MatrixXd::Identity(n, n);
  const Eigen::LLT<Eigen::MatrixXd> llt(S);
  const Eigen::MatrixXd X = Eigen::MatrixXd::Random(n, n);
  Eigen::MatrixXd divided = X;
  DivideByCholesky(llt.matrixLLT(), &divided);
  EXPECT_LT((divided * S - X).norm(), 1e-11 * n);
}

INSTANTIATE_TEST_SUITE_P(Sizes, SmallProduct,
                         ::testing::Values(1, 2, 3, 4, 5, 7, 8, 9, 11, 12, 15,
                                           16, 31, 48));

TEST(SmallSquare, IsSubtractedAtAnySize) {
  using Wide =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  for (const Eigen::Index n : {1, 4, 7, 8, 15, 24}) {
    for (const Eigen::Index m : {0, 1, 3}) {
      const Wide W = Wide::Random(m, n);
      const Eigen::MatrixXd X = Eigen::MatrixXd::Random(n, n);
      Eigen::MatrixXd out = X;
      SubtractSquare(W, &out);
      EXPECT_LT((out - (X - W.transpose() * W)).norm(), 1e-14) << n << m;
    }
  }
}

}  // namespace
}  // namespace hindsight
