#include "linear/arrow_least_squares.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/random.h"

namespace hindsight {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd RandomMatrix(int rows, int cols, Random* random) {
  MatrixXd M(rows, cols);
  for (int j = 0; j < cols; ++j) {
    for (int i = 0; i < rows; ++i) M(i, j) = random->Normal();
  }
  return M;
}

struct Shape {
  int nodes, n, m;
  int Size() const { return nodes * n + m; }
};

/// Rows of one node, or of a node and the next, over all unknowns.
struct DenseRows {
  int node = 0;
  bool is_link = false;
  MatrixXd J;
  VectorXd r;
};

/// A priori values, `seen` rows of each node and one more than there are
/// unknowns of each link, in units that differ from unknown to unknown by
/// `spread`.
std::vector<DenseRows> RandomRows(const Shape& shape, double spread,
                                  Random* random) {
  const int size = shape.Size();
  VectorXd unit(size);
  for (int i = 0; i < size; ++i) unit(i) = std::pow(spread, i % 3 - 1);
  std::vector<DenseRows> all;
  const auto add = [&](int k, bool is_link, int count) {
    MatrixXd J = MatrixXd::Zero(count, size);
    const int width = is_link ? 2 * shape.n : shape.n;
    J.middleCols(k * shape.n, width) = RandomMatrix(count, width, random);
    J.rightCols(shape.m) = RandomMatrix(count, shape.m, random);
    all.push_back({k, is_link, J * unit.asDiagonal(),
                   RandomMatrix(count, 1, random).col(0)});
  };
  add(0, false, shape.n + shape.m);
  for (int k = 0; k < shape.nodes; ++k) {
    if (k + 1 < shape.nodes) add(k, true, shape.n + 1);
    add(k, false, k % 3);
  }
  return all;
}

void Add(const Shape& shape, const DenseRows& rows, ArrowLeastSquares* arrow) {
  const int count = static_cast<int>(rows.r.size());
  ArrowLeastSquares::Rows to = rows.is_link
                                   ? arrow->AddToLink(rows.node, count)
                                   : arrow->AddToNode(rows.node, count);
  to.node() = rows.J.middleCols(rows.node * shape.n, shape.n);
  if (rows.is_link) {
    to.next() = rows.J.middleCols((rows.node + 1) * shape.n, shape.n);
  }
  to.border() = rows.J.rightCols(shape.m);
  to.residual() = rows.r;
}

ArrowLeastSquares Fill(const Shape& shape, const std::vector<DenseRows>& all) {
  ArrowLeastSquares arrow(shape.nodes, shape.n, shape.m);
  for (const DenseRows& rows : all) Add(shape, rows, &arrow);
  return arrow;
}

/// All rows as one dense problem.
DenseRows Stack(const Shape& shape, const std::vector<DenseRows>& all) {
  DenseRows stack;
  for (const DenseRows& rows : all) {
    const Eigen::Index before = stack.r.size();
    stack.J.conservativeResize(before + rows.r.size(), shape.Size());
    stack.r.conservativeResize(before + rows.r.size());
    stack.J.bottomRows(rows.r.size()) = rows.J;
    stack.r.tail(rows.r.size()) = rows.r;
  }
  return stack;
}

VectorXd SolutionOf(const Shape& shape, const ArrowLeastSquares& arrow) {
  VectorXd x(shape.Size());
  for (int k = 0; k < shape.nodes; ++k) {
    x.segment(k * shape.n, shape.n) = arrow.x(k);
  }
  x.tail(shape.m) = arrow.x_border();
  return x;
}

class ArrowShapes : public testing::TestWithParam<Shape> {};

TEST_P(ArrowShapes, SolutionEqualsDenseSolution) {
  const Shape shape = GetParam();
  Random random(1);
  const std::vector<DenseRows> all = RandomRows(shape, 1e3, &random);
  const DenseRows dense = Stack(shape, all);
  const VectorXd unit = dense.J.colwise().norm().transpose();
  const MatrixXd scaled = dense.J * unit.cwiseInverse().asDiagonal();
  const VectorXd expected = scaled.colPivHouseholderQr().solve(-dense.r);
  ArrowLeastSquares arrow = Fill(shape, all);
  EXPECT_TRUE(arrow.Solve().empty());
  const VectorXd x = unit.cwiseProduct(SolutionOf(shape, arrow));
  EXPECT_LT((x - expected).norm(), 1e-11 * expected.norm());
}

TEST_P(ArrowShapes, MarginalsEqualBlocksOfDenseInverse) {
  const Shape shape = GetParam();
  const int n = shape.n;
  Random random(2);
  const std::vector<DenseRows> all = RandomRows(shape, 1e3, &random);
  const DenseRows dense = Stack(shape, all);
  const VectorXd unit = dense.J.colwise().norm().transpose();
  // Compared with unit columns, where one tolerance fits every element.
  const MatrixXd scaled = dense.J * unit.cwiseInverse().asDiagonal();
  const MatrixXd inverse = (scaled.transpose() * scaled).inverse();
  const auto expect_block = [&](int row, int column, const MatrixXd& block) {
    const MatrixXd in_units = unit.segment(row, block.rows()).asDiagonal() *
                              block *
                              unit.segment(column, block.cols()).asDiagonal();
    EXPECT_LT(
        (in_units - inverse.block(row, column, block.rows(), block.cols()))
            .norm(),
        1e-10 * inverse.norm())
        << "block at " << row << ", " << column;
  };
  ArrowLeastSquares arrow = Fill(shape, all);
  arrow.Solve();
  int expected_node = shape.nodes - 1;
  arrow.VisitMarginals([&](const ArrowLeastSquares::NodeMarginal& marginal) {
    const int k = marginal.node;
    EXPECT_EQ(k, expected_node--);
    ASSERT_EQ(marginal.covariance.rows(), n);
    ASSERT_EQ(marginal.border_node.rows(), shape.m);
    ASSERT_EQ(marginal.next_node.rows(), k + 1 < shape.nodes ? n : 0);
    expect_block(k * n, k * n, marginal.covariance);
    expect_block((k + 1) * n, k * n, marginal.next_node);
    expect_block(shape.nodes * n, k * n, marginal.border_node);
  });
  EXPECT_EQ(expected_node, -1);
  const MatrixXd border = arrow.BorderCovariance();
  ASSERT_EQ(border.rows(), shape.m);
  expect_block(shape.nodes * n, shape.nodes * n, border);
}

INSTANTIATE_TEST_SUITE_P(Shapes, ArrowShapes,
                         testing::Values(Shape{1, 1, 0}, Shape{1, 15, 0},
                                         Shape{1, 6, 3}, Shape{2, 2, 1},
                                         Shape{7, 3, 0}, Shape{5, 9, 4},
                                         Shape{12, 15, 0}, Shape{12, 15, 7},
                                         Shape{4, 16, 2}, Shape{6, 17, 33},
                                         Shape{3, 36, 5}),
                         [](const auto& info) {
                           return "K" + std::to_string(info.param.nodes) + "n" +
                                  std::to_string(info.param.n) + "m" +
                                  std::to_string(info.param.m);
                         });

/// One row of scalars: a x_k + b x_(k+1) = z.
void AddScalar(int k, double a, double b, double z, ArrowLeastSquares* arrow) {
  ArrowLeastSquares::Rows row =
      b == 0.0 ? arrow->AddToNode(k, 1) : arrow->AddToLink(k, 1);
  row.node()(0, 0) = a;
  if (b != 0.0) row.next()(0, 0) = b;
  row.residual()(0, 0) = -z;
}

TEST(ArrowLeastSquares, HandComputedRandomWalkOfTwoNodes) {
  // Prior of variance 4 at node 0, step of variance 2: variances 4 and 6,
  // covariance 4; an observation 3 of node 1 with variance 3.
  ArrowLeastSquares arrow(2, 1, 0);
  AddScalar(0, 1.0 / 2.0, 0.0, 0.0, &arrow);
  AddScalar(0, -std::sqrt(0.5), std::sqrt(0.5), 0.0, &arrow);
  AddScalar(1, std::sqrt(1.0 / 3.0), 0.0, 3.0 * std::sqrt(1.0 / 3.0), &arrow);
  EXPECT_TRUE(arrow.Solve().empty());
  // Gains 4/9 and 6/9 of the innovation 3.
  EXPECT_NEAR(arrow.x(0)(0), 4.0 / 3.0, 1e-15);
  EXPECT_NEAR(arrow.x(1)(0), 2.0, 1e-15);
  std::vector<double> variances(2);
  double covariance = 0.0;
  arrow.VisitMarginals([&](const ArrowLeastSquares::NodeMarginal& marginal) {
    variances[static_cast<std::size_t>(marginal.node)] =
        marginal.covariance(0, 0);
    if (marginal.node == 0) covariance = marginal.next_node(0, 0);
  });
  EXPECT_NEAR(variances[0], 4.0 - 16.0 / 9.0, 1e-14);
  EXPECT_NEAR(variances[1], 6.0 - 36.0 / 9.0, 1e-14);
  EXPECT_NEAR(covariance, 4.0 - 24.0 / 9.0, 1e-14);
}

/// A random walk of step variance q with a prior of variance one, observed at
/// every node with unit variance, against the scalar Kalman filter and RTS
/// smoother, which do not cancel.
TEST(ArrowLeastSquares, StiffLinksCostHalfTheDigits) {
  constexpr int kNodes = 500;
  for (const double q : {1e-3, 1e-9, 1e-15, 1e-20}) {
    ArrowLeastSquares arrow(kNodes, 1, 0);
    std::vector<double> filtered;
    std::vector<double> predicted;
    for (int k = 0; k < kNodes; ++k) {
      AddScalar(k, 1.0, 0.0, 0.0, &arrow);
      if (k + 1 < kNodes) {
        AddScalar(k, -1.0 / std::sqrt(q), 1.0 / std::sqrt(q), 0.0, &arrow);
      }
      predicted.push_back(k == 0 ? 0.0 : filtered.back() + q);
      filtered.push_back(k == 0 ? 1.0
                                : predicted.back() / (1.0 + predicted.back()));
    }
    EXPECT_TRUE(arrow.Solve().empty());
    double smoothed = filtered.back();
    arrow.VisitMarginals([&](const ArrowLeastSquares::NodeMarginal& marginal) {
      const auto k = static_cast<std::size_t>(marginal.node);
      if (marginal.node + 1 < kNodes) {
        const double gain = filtered[k] / predicted[k + 1];
        smoothed = filtered[k] + gain * gain * (smoothed - predicted[k + 1]);
      }
      EXPECT_NEAR(marginal.covariance(0, 0) / smoothed, 1.0,
                  100.0 * std::numeric_limits<double>::epsilon() / std::sqrt(q))
          << "q = " << q << ", node " << k;
    });
  }
}

TEST(ArrowLeastSquares, UnknownWithoutInformationIsNamedAndHeldFixed) {
  const Shape shape{4, 3, 2};
  Random random(4);
  std::vector<DenseRows> all = RandomRows(shape, 1e4, &random);
  for (const int lost : {2 * shape.n + 1, 3 * shape.n, 4 * shape.n}) {
    std::vector<DenseRows> rows = all;
    for (DenseRows& one : rows) one.J.col(lost).setZero();
    ArrowLeastSquares arrow = Fill(shape, rows);
    const std::vector<Deficiency> found = arrow.Solve();
    ASSERT_EQ(found.size(), 1u);
    const bool in_border = lost == 4 * shape.n;
    EXPECT_EQ(found[0].node, in_border ? Deficiency::kBorder : lost / shape.n);
    EXPECT_EQ(found[0].component, lost % shape.n);
    EXPECT_EQ(found[0].relative_pivot, 0.0);
    // The other unknowns are those of the problem without the lost one.
    DenseRows dense = Stack(shape, rows);
    const VectorXd unit = dense.J.colwise().norm().transpose().cwiseMax(1e-300);
    const MatrixXd scaled = dense.J * unit.cwiseInverse().asDiagonal();
    const VectorXd expected = scaled.colPivHouseholderQr().solve(-dense.r);
    const VectorXd x = unit.cwiseProduct(SolutionOf(shape, arrow));
    EXPECT_EQ(x(lost), 0.0);
    EXPECT_LT((x - expected).norm(), 1e-11 * expected.norm());
    arrow.VisitMarginals([&](const ArrowLeastSquares::NodeMarginal& marginal) {
      EXPECT_TRUE(marginal.covariance.allFinite());
      if (!in_border && marginal.node == lost / shape.n) {
        EXPECT_EQ(marginal.covariance.col(lost % shape.n).norm(), 0.0);
      }
    });
  }
}

/// What a row with an undetermined unknown says of the unknowns after it is
/// kept: x_0 is seen together with x_1 alone, twice alike.
TEST(ArrowLeastSquares, RowsOfAnUndeterminedUnknownStillTellTheOthers) {
  ArrowLeastSquares arrow(1, 3, 0);
  ArrowLeastSquares::Rows rows = arrow.AddToNode(0, 3);
  rows.node() << 1.0, 1.0, 0.0,  //
      1.0, 1.0, 1.0,             //
      0.0, 0.0, 2.0;
  rows.residual() << -3.0, -5.0, -4.0;
  const std::vector<Deficiency> found = arrow.Solve();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].component, 1);
  EXPECT_NEAR(arrow.x(0)(0), 3.0, 1e-14);
  EXPECT_EQ(arrow.x(0)(1), 0.0);
  EXPECT_NEAR(arrow.x(0)(2), 2.0, 1e-14);
}

/// Only differences along the chain are known: the common part vanishes at the
/// last node, whatever the units.
TEST(ArrowLeastSquares, UndeterminedCommonPartIsReportedAtTheLastNode) {
  constexpr int kNodes = 20;
  for (const double unit : {1e-6, 1.0, 1e6}) {
    ArrowLeastSquares arrow(kNodes, 2, 0);
    for (int k = 0; k < kNodes; ++k) {
      arrow.AddToNode(k, 1).node()(0, 1) = 1.0;
      if (k + 1 == kNodes) continue;
      ArrowLeastSquares::Rows link = arrow.AddToLink(k, 2);
      link.node().diagonal() << -unit, -1.0;
      link.next().diagonal() << unit, 1.0;
    }
    const std::vector<Deficiency> found = arrow.Solve();
    ASSERT_EQ(found.size(), 1u) << unit;
    EXPECT_EQ(found[0].node, kNodes - 1);
    EXPECT_EQ(found[0].component, 0);
    EXPECT_LT(std::abs(found[0].relative_pivot), 1e-14);
  }
}

TEST(ArrowLeastSquares, BorderInseparableFromTheNodesIsReportedAsBorder) {
  // Observations of the sum of node and border alone.
  ArrowLeastSquares arrow(3, 1, 1);
  for (int k = 0; k < 3; ++k) {
    ArrowLeastSquares::Rows row = arrow.AddToNode(k, 1);
    row.node()(0, 0) = 1.0;
    row.border()(0, 0) = 1.0;
  }
  const std::vector<Deficiency> found = arrow.Solve();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].node, Deficiency::kBorder);
  EXPECT_EQ(found[0].component, 0);
  EXPECT_EQ(arrow.BorderCovariance()(0, 0), 0.0);
}

TEST(ArrowLeastSquares, NotANumberIsADeficiencyAndNotPassedOn) {
  ArrowLeastSquares arrow(2, 1, 0);
  AddScalar(0, std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0, &arrow);
  AddScalar(1, std::sqrt(2.0), 0.0, std::sqrt(8.0), &arrow);
  const std::vector<Deficiency> found = arrow.Solve();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].node, 0);
  EXPECT_DOUBLE_EQ(arrow.x(1)(0), 2.0);
}

TEST(ArrowLeastSquares, CallsOutOfOrderAreRefused) {
  ArrowLeastSquares arrow(2, 2, 1);
  EXPECT_THROW(arrow.VisitMarginals([](const auto&) {}), std::logic_error);
  EXPECT_THROW(arrow.BorderCovariance(), std::logic_error);
  arrow.AddToNode(1, 1);
  EXPECT_THROW(arrow.AddToNode(0, 1), std::logic_error);
  EXPECT_THROW(arrow.AddToLink(1, 1), std::logic_error);
  EXPECT_THROW(arrow.AddToNode(2, 1), std::logic_error);
  EXPECT_EQ(arrow.Solve().size(), 5u);
  EXPECT_THROW(arrow.Solve(), std::logic_error);
  EXPECT_THROW(arrow.AddToNode(1, 1), std::logic_error);
  EXPECT_THROW(ArrowLeastSquares(0, 2, 1), std::logic_error);
}

}  // namespace
}  // namespace hindsight
