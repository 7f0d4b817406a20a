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

}  // namespace
}  // namespace hindsight
