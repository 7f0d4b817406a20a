#include "factors/state_blocks.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "support/test_motion.h"

namespace hindsight {
namespace {

using testing::RandomError;
using testing::RichLayout;
using testing::TypicalState;

using RowMajorMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

ImuNoise WalkingNoise() {
  ImuNoise noise;
  noise.gyro_bias_walk = 1e-6;
  return noise;  // the accelerometer bias stays constant: a global
}

State RichState(const ErrorLayout& layout) {
  State x = TypicalState();
  x.parameters = ParameterVector::LinSpaced(layout.parameter_count(), 0.1, 0.9);
  return x;
}

/// The rich layout's node: p, v, psi, b_g, coloured noise, height offset.
class NodeManifoldTest : public ::testing::Test {
 protected:
  NodeManifoldTest()
      : layout_(RichLayout(WalkingNoise())),
        blocks_(layout_),
        manifold_(&blocks_),
        x_(blocks_.node_ambient_dim()) {
    blocks_.WriteNode(RichState(layout_), x_.data());
  }

  Eigen::VectorXd Plus(const Eigen::VectorXd& x,
                       const Eigen::VectorXd& d) const {
    Eigen::VectorXd y(x.size());
    EXPECT_TRUE(manifold_.Plus(x.data(), d.data(), y.data()));
    return y;
  }
  Eigen::VectorXd Minus(const Eigen::VectorXd& y,
                        const Eigen::VectorXd& x) const {
    Eigen::VectorXd d(manifold_.TangentSize());
    EXPECT_TRUE(manifold_.Minus(y.data(), x.data(), d.data()));
    return d;
  }
  Eigen::VectorXd SomeStep(double size) const {
    Random random(3);
    Eigen::VectorXd d(manifold_.TangentSize());
    for (double& value : d) value = size * random.Normal();
    return d;
  }

  ErrorLayout layout_;
  StateBlocks blocks_;
  NodeManifold manifold_;
  Eigen::VectorXd x_;
};

TEST_F(NodeManifoldTest, SizesCountNodeBlocksOnly) {
  EXPECT_EQ(manifold_.TangentSize(), 3 + 3 + 3 + 3 + 3 + 1);
  EXPECT_EQ(manifold_.AmbientSize(), manifold_.TangentSize() + 1);
  // Accelerometer bias, two IMU scales, lever arm, time offset.
  EXPECT_EQ(blocks_.globals().size(), 5u);
  EXPECT_EQ(blocks_.global_dim(), 3 + 3 + 3 + 3 + 1);
}

TEST_F(NodeManifoldTest, MinusUndoesPlus) {
  for (const double size : {1e-6, 0.01, 0.5}) {
    const Eigen::VectorXd d = SomeStep(size);
    EXPECT_LT((Minus(Plus(x_, d), x_) - d).cwiseAbs().maxCoeff(), 3e-9);
  }
  EXPECT_TRUE(Minus(x_, x_).isZero(1e-16));
}

TEST_F(NodeManifoldTest, PlusIsRetract) {
  const Eigen::VectorXd d = SomeStep(0.3);
  ErrorVector full = ErrorVector::Zero(layout_.dim());
  for (const StateBlocks::Entry& entry : blocks_.entries()) {
    if (entry.global) continue;
    full.segment(entry.block.offset, entry.block.dim) =
        d.segment(entry.tangent, entry.block.dim);
  }
  Eigen::VectorXd expected(x_.size());
  blocks_.WriteNode(Retract(layout_, RichState(layout_), full),
                    expected.data());
  EXPECT_LT((Plus(x_, d) - expected).cwiseAbs().maxCoeff(), 2e-9);
}

TEST_F(NodeManifoldTest, PlusJacobianMatchesNumericDifference) {
  RowMajorMatrix J(manifold_.AmbientSize(), manifold_.TangentSize());
  manifold_.PlusJacobian(x_.data(), J.data());
  for (int c = 0; c < manifold_.TangentSize(); ++c) {
    // Rounding of 6.4e6 m over 2 m, third derivative of a quaternion h^2/48.
    const double h = c < 3 ? 1.0 : 1e-4;
    Eigen::VectorXd step = Eigen::VectorXd::Zero(manifold_.TangentSize());
    step(c) = h;
    const Eigen::VectorXd column =
        (Plus(x_, step) - Plus(x_, -step)) / (2.0 * h);
    EXPECT_LT((column - J.col(c)).cwiseAbs().maxCoeff(), 2e-9) << c;
  }
}

TEST_F(NodeManifoldTest, MinusJacobianMatchesNumericDifference) {
  RowMajorMatrix J(manifold_.TangentSize(), manifold_.AmbientSize());
  manifold_.MinusJacobian(x_.data(), J.data());
  for (int c = 0; c < manifold_.AmbientSize(); ++c) {
    // Log does not see the length of a quaternion: the difference along it is
    // zero, and so is the Jacobian's.
    const double h = c < 3 ? 1.0 : 1e-4;
    Eigen::VectorXd plus = x_;
    Eigen::VectorXd minus = x_;
    plus(c) += h;
    minus(c) -= h;
    const Eigen::VectorXd column =
        (Minus(plus, x_) - Minus(minus, x_)) / (2.0 * h);
    EXPECT_LT((column - J.col(c)).cwiseAbs().maxCoeff(), 1e-7) << c;
  }
}

TEST_F(NodeManifoldTest, MinusJacobianInvertsPlusJacobian) {
  RowMajorMatrix plus(manifold_.AmbientSize(), manifold_.TangentSize());
  RowMajorMatrix minus(manifold_.TangentSize(), manifold_.AmbientSize());
  manifold_.PlusJacobian(x_.data(), plus.data());
  manifold_.MinusJacobian(x_.data(), minus.data());
  EXPECT_TRUE((minus * plus).isIdentity(1e-14));
}

TEST(StateBlocks, StatesSurviveTheParameterBlocks) {
  const ErrorLayout layout = RichLayout(WalkingNoise());
  const StateBlocks blocks(layout);
  const State x = RichState(layout);
  Eigen::VectorXd node(blocks.node_ambient_dim());
  blocks.WriteNode(x, node.data());
  std::vector<Eigen::Vector3d> values(blocks.globals().size());
  std::vector<const double*> globals;
  for (std::size_t g = 0; g < values.size(); ++g) {
    blocks.WriteGlobal(x, static_cast<int>(g), values[g].data());
    globals.push_back(values[g].data());
  }
  const State y = blocks.ReadState(x.t, node.data(), globals);
  EXPECT_EQ(y.p_e, x.p_e);
  EXPECT_EQ(y.v_e, x.v_e);
  EXPECT_EQ(y.q_eb.coeffs(), x.q_eb.coeffs());
  EXPECT_EQ(y.b_g, x.b_g);
  EXPECT_EQ(y.b_a, x.b_a);
  EXPECT_EQ(y.parameters, x.parameters);
}

TEST(StateBlocks, RefusesMaskedAxesAndIncompletePoses) {
  Block position;
  position.key.kind = BlockKind::kPosition;
  position.name = "position";
  position.evolution = Evolution::Navigation();
  ErrorLayout only;
  only.Add(position);
  EXPECT_THROW(StateBlocks{only}, std::logic_error);
  ErrorLayout masked;
  const ErrorLayout complete = testing::TypicalLayout();
  for (Block block : complete.blocks()) {
    if (block.key.kind == BlockKind::kAccelBias) block.active[1] = false;
    masked.Add(block);
  }
  EXPECT_THROW(StateBlocks{masked}, std::logic_error);
}

}  // namespace
}  // namespace hindsight
