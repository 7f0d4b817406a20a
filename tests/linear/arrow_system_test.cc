#include "linear/arrow_system.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
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

// Information of a chain of random relative measurements between neighbours
// and the border, in units that differ from unknown to unknown by `spread`.
MatrixXd RandomInformation(const Shape& shape, double spread, Random* random) {
  const int size = shape.Size();
  MatrixXd information = MatrixXd::Identity(size, size);
  for (int k = 0; k < shape.nodes; ++k) {
    const int width = std::min(2 * shape.n, (shape.nodes - k) * shape.n);
    MatrixXd J = MatrixXd::Zero(shape.n + 2, size);
    J.middleCols(k * shape.n, width) = RandomMatrix(shape.n + 2, width, random);
    J.rightCols(shape.m) = RandomMatrix(shape.n + 2, shape.m, random);
    information += J.transpose() * J;
  }
  VectorXd unit(size);
  for (int i = 0; i < size; ++i) unit(i) = std::pow(spread, i % 3 - 1);
  return unit.asDiagonal() * information * unit.asDiagonal();
}

void Fill(const Shape& shape, const MatrixXd& information,
          ArrowSystem* system) {
  const int n = shape.n;
  for (int k = 0; k < shape.nodes; ++k) {
    system->node(k) = information.block(k * n, k * n, n, n);
    if (k + 1 < shape.nodes) {
      system->coupling(k) = information.block((k + 1) * n, k * n, n, n);
    }
    system->border_coupling(k) =
        information.block(shape.nodes * n, k * n, shape.m, n);
  }
  system->border() = information.bottomRightCorner(shape.m, shape.m);
}

class ArrowSystemShapes : public testing::TestWithParam<Shape> {};

TEST_P(ArrowSystemShapes, SolutionEqualsDenseSolution) {
  const Shape shape = GetParam();
  Random random(1);
  const MatrixXd information = RandomInformation(shape, 1e3, &random);
  const VectorXd x = RandomMatrix(shape.Size(), 1, &random);
  const VectorXd b = information * x;
  ArrowSystem system(shape.nodes, shape.n, shape.m);
  Fill(shape, information, &system);
  EXPECT_TRUE(system.Factor().empty());
  for (int repeat = 0; repeat < 2; ++repeat) {
    for (int k = 0; k < shape.nodes; ++k) {
      system.rhs(k) = b.segment(k * shape.n, shape.n);
    }
    system.rhs_border() = b.tail(shape.m);
    system.Solve();
    VectorXd solution(shape.Size());
    for (int k = 0; k < shape.nodes; ++k) {
      solution.segment(k * shape.n, shape.n) = system.rhs(k);
    }
    solution.tail(shape.m) = system.rhs_border();
    // Units differ by 1e6, so each unknown is judged in its own.
    const VectorXd unit = information.diagonal().cwiseSqrt();
    EXPECT_LT((unit.asDiagonal() * (solution - x)).norm(),
              1e-11 * (unit.asDiagonal() * x).norm());
  }
}

TEST_P(ArrowSystemShapes, MarginalsEqualBlocksOfDenseInverse) {
  const Shape shape = GetParam();
  const int n = shape.n;
  Random random(2);
  const MatrixXd information = RandomInformation(shape, 1e3, &random);
  const VectorXd scale = information.diagonal().cwiseSqrt();
  // Compared with unit diagonal, where one tolerance fits every element.
  const MatrixXd inverse = (scale.cwiseInverse().asDiagonal() * information *
                            scale.cwiseInverse().asDiagonal())
                               .inverse();
  const auto expect_block = [&](int row, int column, const MatrixXd& block) {
    const MatrixXd scaled = scale.segment(row, block.rows()).asDiagonal() *
                            block *
                            scale.segment(column, block.cols()).asDiagonal();
    EXPECT_LT((scaled - inverse.block(row, column, block.rows(), block.cols()))
                  .norm(),
              1e-10 * inverse.norm())
        << "block at " << row << ", " << column;
  };
  ArrowSystem system(shape.nodes, n, shape.m);
  Fill(shape, information, &system);
  system.Factor();
  int expected_node = shape.nodes - 1;
  system.VisitMarginals([&](const ArrowSystem::NodeMarginal& marginal) {
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
  const MatrixXd border = system.BorderCovariance();
  ASSERT_EQ(border.rows(), shape.m);
  expect_block(shape.nodes * n, shape.nodes * n, border);
}

INSTANTIATE_TEST_SUITE_P(Shapes, ArrowSystemShapes,
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

TEST(ArrowSystem, HandComputedRandomWalkOfTwoNodes) {
  // Prior of variance 4 at node 0, step of variance 2: variances 4 and 6,
  // covariance 4; an observation 3 of node 1 with variance 3 adds 1/3.
  ArrowSystem system(2, 1, 0);
  system.node(0)(0, 0) = 1.0 / 4.0 + 1.0 / 2.0;
  system.coupling(0)(0, 0) = -1.0 / 2.0;
  system.node(1)(0, 0) = 1.0 / 2.0 + 1.0 / 3.0;
  system.rhs(1)(0) = 3.0 / 3.0;
  EXPECT_TRUE(system.Factor().empty());
  system.Solve();
  // Gains 4/9 and 6/9 of the innovation 3.
  EXPECT_NEAR(system.rhs(0)(0), 4.0 / 3.0, 1e-15);
  EXPECT_NEAR(system.rhs(1)(0), 2.0, 1e-15);
  std::vector<double> variances(2);
  double covariance = 0.0;
  system.VisitMarginals([&](const ArrowSystem::NodeMarginal& marginal) {
    variances[static_cast<std::size_t>(marginal.node)] =
        marginal.covariance(0, 0);
    if (marginal.node == 0) covariance = marginal.next_node(0, 0);
  });
  EXPECT_NEAR(variances[0], 4.0 - 16.0 / 9.0, 1e-14);
  EXPECT_NEAR(variances[1], 6.0 - 36.0 / 9.0, 1e-14);
  EXPECT_NEAR(covariance, 4.0 - 24.0 / 9.0, 1e-14);
}

// A random walk of step variance q observed at every node with unit variance,
// against the scalar Kalman filter and RTS smoother, which do not cancel.
TEST(ArrowSystem, AccuracyFollowsTheStiffnessOfTheLinks) {
  constexpr int kNodes = 500;
  for (const double q : {1e-3, 1e-6, 1e-9}) {
    ArrowSystem system(kNodes, 1, 0);
    std::vector<double> filtered;
    std::vector<double> predicted;
    for (int k = 0; k < kNodes; ++k) {
      const bool first = k == 0;
      const bool last = k + 1 == kNodes;
      system.node(k)(0, 0) = 1.0 + (first || last ? 1.0 : 2.0) / q;
      if (!last) system.coupling(k)(0, 0) = -1.0 / q;
      predicted.push_back(first ? 0.0 : filtered.back() + q);
      filtered.push_back(first ? 1.0
                               : predicted.back() / (1.0 + predicted.back()));
    }
    EXPECT_TRUE(system.Factor().empty());
    double smoothed = filtered.back();
    system.VisitMarginals([&](const ArrowSystem::NodeMarginal& marginal) {
      const auto k = static_cast<std::size_t>(marginal.node);
      if (marginal.node + 1 < kNodes) {
        const double gain = filtered[k] / predicted[k + 1];
        smoothed = filtered[k] + gain * gain * (smoothed - predicted[k + 1]);
      }
      EXPECT_NEAR(marginal.covariance(0, 0) / smoothed, 1.0,
                  10.0 * std::numeric_limits<double>::epsilon() / q);
    });
  }
}

TEST(ArrowSystem, UpperTrianglesAreNotRead) {
  const Shape shape{3, 3, 2};
  Random random(3);
  const MatrixXd information = RandomInformation(shape, 1.0, &random);
  ArrowSystem full(shape.nodes, shape.n, shape.m);
  ArrowSystem lower(shape.nodes, shape.n, shape.m);
  Fill(shape, information, &full);
  Fill(shape, information, &lower);
  for (int k = 0; k < shape.nodes; ++k) lower.node(k)(0, 2) = 1e9;
  lower.border()(0, 1) = 1e9;
  for (ArrowSystem* system : {&full, &lower}) {
    system->rhs(0).setOnes();
    EXPECT_TRUE(system->Factor().empty());
    system->Solve();
  }
  EXPECT_EQ(full.rhs(2), lower.rhs(2));
  EXPECT_EQ(full.rhs_border(), lower.rhs_border());
  EXPECT_EQ(full.BorderCovariance(), lower.BorderCovariance());
}

TEST(ArrowSystem, UnknownWithoutInformationIsNamedAndHeldFixed) {
  const Shape shape{4, 3, 0};
  Random random(4);
  MatrixXd information = RandomInformation(shape, 1e4, &random);
  const int lost = 2 * shape.n + 1;
  information.row(lost).setZero();
  information.col(lost).setZero();
  ArrowSystem system(shape.nodes, shape.n, shape.m);
  Fill(shape, information, &system);
  system.rhs(0).setOnes();
  const std::vector<Deficiency> found = system.Factor();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].node, 2);
  EXPECT_EQ(found[0].component, 1);
  EXPECT_EQ(found[0].relative_pivot, 0.0);
  system.Solve();
  EXPECT_EQ(system.rhs(2)(1), 0.0);
  // The other unknowns are those of the system without the lost one.
  information(lost, lost) = 1.0;
  VectorXd b = VectorXd::Zero(shape.Size());
  b.head(shape.n).setOnes();
  const VectorXd x = information.llt().solve(b);
  EXPECT_LT((system.rhs(3) - x.tail(3)).norm(), 1e-11 * x.tail(3).norm());
  system.VisitMarginals([&](const ArrowSystem::NodeMarginal& marginal) {
    EXPECT_TRUE(marginal.covariance.allFinite());
    if (marginal.node == 2) {
      EXPECT_EQ(marginal.covariance.col(1).norm(), 0.0);
    }
  });
}

// Only differences along the chain are known: the common part vanishes at the
// last node, whatever the units.
TEST(ArrowSystem, UndeterminedCommonPartIsReportedAtTheLastNode) {
  constexpr int kNodes = 20;
  for (const double unit : {1e-6, 1.0, 1e6}) {
    ArrowSystem system(kNodes, 2, 0);
    for (int k = 0; k < kNodes; ++k) {
      system.node(k)(0, 0) = (k == 0 || k == kNodes - 1 ? 1.0 : 2.0) * unit;
      system.node(k)(1, 1) = 2.1;
      if (k + 1 == kNodes) continue;
      system.coupling(k)(0, 0) = -unit;
      system.coupling(k)(1, 1) = -1.0;
    }
    const std::vector<Deficiency> found = system.Factor(1e-12);
    ASSERT_EQ(found.size(), 1u) << unit;
    EXPECT_EQ(found[0].node, kNodes - 1);
    EXPECT_EQ(found[0].component, 0);
    EXPECT_LT(std::abs(found[0].relative_pivot), 1e-13);
  }
}

TEST(ArrowSystem, BorderUnknownInseparableFromTheNodesIsReportedAsBorder) {
  // Observations of the sum of node and border alone.
  ArrowSystem system(3, 1, 1);
  for (int k = 0; k < 3; ++k) {
    system.node(k)(0, 0) = 1.0;
    system.border_coupling(k)(0, 0) = 1.0;
  }
  system.border()(0, 0) = 3.0;
  const std::vector<Deficiency> found = system.Factor();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].node, Deficiency::kBorder);
  EXPECT_EQ(found[0].component, 0);
  EXPECT_EQ(system.BorderCovariance()(0, 0), 0.0);
}

TEST(ArrowSystem, NotANumberIsADeficiencyAndNotPassedOn) {
  ArrowSystem system(2, 1, 0);
  system.node(0)(0, 0) = std::numeric_limits<double>::quiet_NaN();
  system.node(1)(0, 0) = 2.0;
  system.rhs(1)(0) = 4.0;
  const std::vector<Deficiency> found = system.Factor();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].node, 0);
  system.Solve();
  EXPECT_DOUBLE_EQ(system.rhs(1)(0), 2.0);
}

TEST(ArrowSystem, CallsOutOfOrderAreRefused) {
  ArrowSystem system(2, 2, 1);
  EXPECT_THROW(system.Solve(), std::logic_error);
  EXPECT_THROW(system.VisitMarginals([](const auto&) {}), std::logic_error);
  EXPECT_THROW(system.BorderCovariance(), std::logic_error);
  system.Factor();
  EXPECT_THROW(system.Factor(), std::logic_error);
  system.SetZero();
  EXPECT_EQ(system.Factor().size(), 5u);
  EXPECT_THROW(ArrowSystem(0, 2, 1), std::logic_error);
}

}  // namespace
}  // namespace hindsight
