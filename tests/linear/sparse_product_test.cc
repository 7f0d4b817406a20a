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

// Sizes about the strips of eight rows: less, whole, some over, one over; rows of zeros
// and of the identity among others.
TEST(SparseProduct, CongruenceEqualsTheDenseOne) {
  for (const Eigen::Index n : {1, 5, 8, 11, 16, 17, 21}) {
    Eigen::MatrixXd S = Eigen::MatrixXd::Random(n, n);
    for (Eigen::Index i = 0; i < S.size(); i += 3) S(i) = 0.0;
    if (n > 2) S.row(2).setZero();
    for (const Eigen::Index i : {1, 4, 15}) {
      if (i < n) S.row(i) = Eigen::RowVectorXd::Unit(n, i);
    }
    const Eigen::MatrixXd A = Eigen::MatrixXd::Random(n, n);
    const Eigen::MatrixXd P = A * A.transpose();
    const SparseCongruence congruence(S);
    Eigen::MatrixXd out = P;
    congruence.ApplyCongruence(&out);
    EXPECT_LT((out - S * P * S.transpose()).norm(), 1e-12) << n;
    EXPECT_EQ(out, out.transpose()) << n;
    Eigen::VectorXd v = A.col(0);
    congruence.ApplyTo(&v);
    EXPECT_LT((v - S * A.col(0)).norm(), 1e-14) << n;
  }
}

TEST(SparseProduct, CongruenceOfOneOfZeroAndOfNone) {
  const Eigen::MatrixXd A = Eigen::MatrixXd::Random(9, 9);
  const Eigen::MatrixXd P = A * A.transpose();
  const auto of = [&P](const SparseCongruence& S) {
    Eigen::MatrixXd out = P;
    S.ApplyCongruence(&out);
    return out;
  };
  EXPECT_EQ(of(SparseCongruence(Eigen::MatrixXd::Identity(9, 9))), P);
  EXPECT_EQ(of(SparseCongruence()), P);
  EXPECT_TRUE(of(SparseCongruence(Eigen::MatrixXd::Zero(9, 9))).isZero(0.0));
}

TEST(SparseProduct, CongruenceLeavesWhatItHasNoRowsFor) {
  const Eigen::MatrixXd S = Eigen::MatrixXd::Random(9, 9);
  Eigen::MatrixXd whole = Eigen::MatrixXd::Identity(14, 14);
  whole.topLeftCorner(9, 9) = S;
  const Eigen::MatrixXd A = Eigen::MatrixXd::Random(14, 14);
  const Eigen::MatrixXd P = A * A.transpose();
  Eigen::MatrixXd out = P;
  SparseCongruence(S).ApplyCongruence(&out);
  EXPECT_LT((out - whole * P * whole.transpose()).norm(), 1e-12);
}

}  // namespace
}  // namespace hindsight
