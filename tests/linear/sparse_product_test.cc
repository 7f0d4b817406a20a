#include "linear/sparse_product.h"

#include <gtest/gtest.h>

namespace hindsight {
namespace {

TEST(SparseProduct, EqualsTheDenseOne) {
  Eigen::MatrixXd S = Eigen::MatrixXd::Random(7, 5);
  for (Eigen::Index i = 0; i < S.size(); i += 3) S(i) = 0.0;
  const Eigen::MatrixXd A = Eigen::MatrixXd::Random(4, 5);
  const Eigen::MatrixXd B = Eigen::MatrixXd::Random(4, 7);
  EXPECT_LT((TimesTransposed(A, S) - A * S.transpose()).norm(), 1e-14);
  EXPECT_LT((Times(B, S) - B * S).norm(), 1e-14);
}

// Sizes about the strips of eight rows: less, whole, some over, one over.
TEST(SparseProduct, CongruenceEqualsTheDenseOne) {
  for (const Eigen::Index n : {1, 5, 8, 11, 16, 17, 21}) {
    Eigen::MatrixXd S = Eigen::MatrixXd::Random(n, n);
    for (Eigen::Index i = 0; i < S.size(); i += 3) S(i) = 0.0;
    if (n > 2) S.row(2).setZero();
    const Eigen::MatrixXd A = Eigen::MatrixXd::Random(n, n);
    const Eigen::MatrixXd P = A * A.transpose();
    const Eigen::MatrixXd out = SparseCongruence(S)(P);
    EXPECT_LT((out - S * P * S.transpose()).norm(), 1e-12) << n;
    EXPECT_EQ(out, out.transpose()) << n;
  }
}

}  // namespace
}  // namespace hindsight
