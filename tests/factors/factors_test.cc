#include <gtest/gtest.h>

#include <Eigen/LU>
#include <string>
#include <vector>

#include "base/error.h"
#include "factors/imu_factor.h"
#include "factors/measurement_factor.h"
#include "factors/prior_factor.h"
#include "filters/forward_filter.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using testing::MakeProblem;
using testing::RichLayout;
using testing::TacticalNoise;
using testing::TestProblem;
using testing::TestProblemOptions;
using testing::TypicalLayout;

using Jacobian = TangentFactor::Jacobian;
using RowMajorMatrix = Jacobian;

/// The values of a factor's parameter blocks and steps in their tangents.
class Point {
 public:
  Point(const StateBlocks& blocks, const TangentFactor& factor,
        const std::vector<State>& states)
      : blocks_(blocks), factor_(factor), manifold_(&blocks) {
    for (std::size_t i = 0; i < factor.nodes().size(); ++i) {
      values_.emplace_back(blocks.node_ambient_dim());
      blocks.WriteNode(states[i], values_.back().data());
    }
    for (const int g : factor.globals()) {
      const Block& block = blocks.globals()[static_cast<std::size_t>(g)].block;
      values_.emplace_back(block.dim);
      blocks.WriteGlobal(states[0], g, values_.back().data());
    }
  }

  Eigen::VectorXd Residual() const { return ResidualAt(values_); }

  Jacobian TangentJacobian() const {
    Jacobian J;
    Eigen::VectorXd residual(factor_.num_residuals());
    factor_.Linearize(Pointers(values_).data(), residual.data(), &J);
    return J;
  }

  /// Residual after a step of the tangent component `column`.
  Eigen::VectorXd Moved(int column, double step) const {
    std::vector<Eigen::VectorXd> moved = values_;
    int first = 0;
    for (std::size_t i = 0; i < moved.size(); ++i) {
      const bool node = i < factor_.nodes().size();
      const int dim =
          node ? blocks_.node_dim() : static_cast<int>(moved[i].size());
      if (column >= first && column < first + dim) {
        if (node) {
          Eigen::VectorXd d = Eigen::VectorXd::Zero(dim);
          d(column - first) = step;
          manifold_.Plus(values_[i].data(), d.data(), moved[i].data());
        } else {
          moved[i](column - first) += step;
        }
      }
      first += dim;
    }
    return ResidualAt(moved);
  }

  /// Ceres's Jacobians, brought into the tangent by the PlusJacobian.
  Jacobian CeresJacobian() const {
    std::vector<RowMajorMatrix> ambient;
    std::vector<double*> pointers;
    for (const Eigen::VectorXd& value : values_) {
      ambient.emplace_back(factor_.num_residuals(), value.size());
    }
    for (RowMajorMatrix& J : ambient) pointers.push_back(J.data());
    Eigen::VectorXd residual(factor_.num_residuals());
    EXPECT_TRUE(factor_.Evaluate(Pointers(values_).data(), residual.data(),
                                 pointers.data()));
    Jacobian out(factor_.num_residuals(), factor_.tangent_dim());
    int column = 0;
    for (std::size_t i = 0; i < values_.size(); ++i) {
      Eigen::MatrixXd J = ambient[i];
      if (i < factor_.nodes().size()) {
        RowMajorMatrix plus(manifold_.AmbientSize(), manifold_.TangentSize());
        manifold_.PlusJacobian(values_[i].data(), plus.data());
        J = ambient[i] * plus;
      }
      out.middleCols(column, J.cols()) = J;
      column += static_cast<int>(J.cols());
    }
    return out;
  }

 private:
  static std::vector<const double*> Pointers(
      const std::vector<Eigen::VectorXd>& values) {
    std::vector<const double*> pointers;
    for (const Eigen::VectorXd& value : values)
      pointers.push_back(value.data());
    return pointers;
  }
  Eigen::VectorXd ResidualAt(const std::vector<Eigen::VectorXd>& values) const {
    Eigen::VectorXd residual(factor_.num_residuals());
    EXPECT_TRUE(
        factor_.Evaluate(Pointers(values).data(), residual.data(), nullptr));
    return residual;
  }

  const StateBlocks& blocks_;
  const TangentFactor& factor_;
  NodeManifold manifold_;
  std::vector<Eigen::VectorXd> values_;
};

/// Central differences in the tangent. (ceres::GradientChecker steps relative
/// to the size of the values, metres for ECEF and 1e-8 for a bias: no digits
/// are left of the latter.) Steps: 1 m; 1e-3 of everything else. Third
/// derivatives leave at most h^2, that of 1/(1 + s); rounding of ECEF
/// positions, 2e-9 m over 2 h, is whitened as the position's own columns are.
void ExpectJacobian(const StateBlocks& blocks, const TangentFactor& factor,
                    const std::vector<State>& states, const std::string& name) {
  const Point point(blocks, factor, states);
  const Jacobian J = point.TangentJacobian();
  ASSERT_EQ(J.cols(), factor.tangent_dim()) << name;
  EXPECT_LT((point.CeresJacobian() - J).norm(), 1e-13 * J.norm()) << name;
  for (int c = 0; c < J.cols(); ++c) {
    const bool metre =
        c % blocks.node_dim() < 3 &&
        c < blocks.node_dim() * static_cast<int>(factor.nodes().size());
    const double h = metre ? 1.0 : 1e-3;
    const Eigen::VectorXd numeric =
        (point.Moved(c, h) - point.Moved(c, -h)) / (2.0 * h);
    const double rounding = 1e-9 / h * J.leftCols<3>().norm();
    EXPECT_LT((numeric - J.col(c)).norm(), 2e-6 * J.col(c).norm() + rounding)
        << name << ", column " << c;
  }
}

TestProblem ShortDrive(bool rich, bool walk) {
  TestProblemOptions options;
  options.noise = TacticalNoise(walk);
  options.layout =
      rich ? RichLayout(options.noise) : TypicalLayout(options.noise);
  options.duration = 4.0;
  options.errors = true;
  return MakeProblem(options, 3);
}

/// Neighbouring states off the predicted link by what a start is off.
std::vector<State> PairAt(const TestProblem& problem, std::size_t k) {
  Random random(17);
  std::vector<State> pair;
  for (std::size_t i = k; i < k + 2; ++i) {
    ErrorVector d(problem.layout.dim());
    for (double& value : d) value = 1e-3 * random.Normal();
    pair.push_back(Retract(problem.layout, problem.truth[i], d));
  }
  return pair;
}

TEST(ImuFactor, JacobianMatchesNumericDifference) {
  for (const bool rich : {false, true}) {
    for (const bool walk : {false, true}) {
      const TestProblem problem = ShortDrive(rich, walk);
      Timeline timeline = problem.MakeTimeline();
      const StateBlocks blocks(problem.layout);
      timeline.Integrate(1, CalibrationOf(problem.layout, problem.truth[1]));
      const ImuFactor factor(&blocks, &timeline, 1);
      EXPECT_EQ(factor.num_residuals(), blocks.node_dim());
      ExpectJacobian(blocks, factor, PairAt(problem, 1),
                     std::string(rich ? "rich" : "plain") +
                         (walk ? ", walking" : ", constant"));
    }
  }
}

TEST(ImuFactor, ConstantBiasesAreGlobals) {
  const TestProblem constant = ShortDrive(true, false);
  const StateBlocks blocks(constant.layout);
  Timeline timeline = constant.MakeTimeline();
  timeline.Integrate(0, {});
  const ImuFactor factor(&blocks, &timeline, 0);
  EXPECT_EQ(factor.nodes(), (std::vector<int>{0, 1}));
  EXPECT_EQ(factor.globals().size(), 4u);  // two biases, two scales
  const TestProblem walking = ShortDrive(false, true);
  const StateBlocks walking_blocks(walking.layout);
  Timeline walking_timeline = walking.MakeTimeline();
  walking_timeline.Integrate(0, {});
  const ImuFactor other(&walking_blocks, &walking_timeline, 0);
  EXPECT_TRUE(other.globals().empty());
}

TEST(ImuFactor, CostIsTheMahalanobisDistanceOfTheLink) {
  const TestProblem problem = ShortDrive(false, true);
  Timeline timeline = problem.MakeTimeline();
  const StateBlocks blocks(problem.layout);
  const ImuSummary& summary =
      timeline.Integrate(1, CalibrationOf(problem.layout, problem.truth[1]));
  const ImuFactor factor(&blocks, &timeline, 1);
  const std::vector<State> pair = PairAt(problem, 1);
  ImuLink link;
  EvaluateLink(problem.layout, summary, pair[0], pair[1], false, &link);
  const ImuLink::Matrix15 S = LinkNoise(summary);
  EXPECT_GT(std::abs(S(0, 3)), 0.1 * std::sqrt(S(0, 0) * S(3, 3)));
  EXPECT_NE(S(0, 12), 0.0);  // biases correlate with what they have moved
  const double expected = link.residual.dot(S.fullPivLu().solve(link.residual));
  EXPECT_NEAR(Point(blocks, factor, pair).Residual().squaredNorm() / expected,
              1.0, 1e-8);
}

TEST(ImuFactor, WhitenedJacobianIsTheFiltersTransition) {
  // -J_j^-1 J_i = Phi and (J_j' J_j)^-1 = Q, as the tape has them.
  const TestProblem problem = ShortDrive(false, true);
  Timeline timeline = problem.MakeTimeline();
  const StateBlocks blocks(problem.layout);
  const ImuSummary& summary =
      timeline.Integrate(1, CalibrationOf(problem.layout, problem.truth[1]));
  const std::vector<State> pair = PairAt(problem, 1);
  for (const bool steps : {false, true}) {
    const double t = timeline.node(1).t;
    if (steps) timeline.AddVelocityStep({2.0, t - 0.3, t + 0.4});
    const ImuFactor factor(&blocks, &timeline, 1);
    const Eigen::MatrixXd J = Point(blocks, factor, pair).TangentJacobian();
    Transition transition;
    LinearizeAdvance(problem.layout, {timeline, 1, summary}, pair[0], pair[1],
                     &transition);
    const Eigen::MatrixXd inverse = J.rightCols(15).inverse();
    const Eigen::MatrixXd Phi = -inverse * J.leftCols(15);
    EXPECT_LT((Phi - transition.Phi).cwiseAbs().maxCoeff(), 1e-8);
    EXPECT_LT(
        testing::ScaledDifference(inverse * inverse.transpose(), transition.Q),
        1e-8);
    EXPECT_EQ(transition.Q(3, 3) > 1.0, steps);
  }
}

/// A measurement of each sensor with a covariance that is not diagonal.
Measurement Correlated(const TestProblem& problem, std::size_t index) {
  Measurement z = problem.measurements[index];
  Eigen::Matrix3d R;
  R << 2.0, 0.9, -0.4, 0.9, 1.0, 0.3, -0.4, 0.3, 3.0;
  if (auto* position = std::get_if<PositionFix>(&z.model)) {
    position->R_n = 0.01 * R;
  } else if (auto* velocity = std::get_if<VelocityFix>(&z.model)) {
    velocity->R_n = 0.001 * R;
  }
  return z;
}

TEST(MeasurementFactor, IsTheFiltersModelWhitened) {
  for (const bool rich : {false, true}) {
    TestProblem problem = ShortDrive(rich, true);
    for (const std::size_t i : {4u, 5u}) {
      problem.measurements[i] = Correlated(problem, i);
    }
    const Timeline timeline = problem.MakeTimeline();
    const StateBlocks blocks(problem.layout);
    const std::vector<State> pair = PairAt(problem, 2);
    for (const std::size_t i : {4u, 5u}) {
      const Measurement& z = timeline.all_measurements()[i];
      const MeasurementFactor factor(&blocks, &timeline, 2, &z);
      LinearizedMeasurement expected;
      Evaluate(z, timeline.Context(2, z, problem.layout, pair[0]), &expected);
      const Eigen::MatrixXd R_inverse = expected.R.inverse();
      const Point point(blocks, factor, {pair[0]});
      const Eigen::VectorXd r = point.Residual();
      EXPECT_NEAR(r.squaredNorm(),
                  expected.residual.dot(R_inverse * expected.residual),
                  1e-9 * r.squaredNorm());
      const Eigen::MatrixXd J = point.TangentJacobian();
      // The factor's columns are the node's and its sensor's and the IMU's
      // globals; the filter's H has all the layout's.
      Eigen::MatrixXd H = Eigen::MatrixXd::Zero(3, factor.tangent_dim());
      int column = blocks.node_dim();
      for (const StateBlocks::Entry& entry : blocks.entries()) {
        const Block& b = entry.block;
        if (!entry.global) {
          H.middleCols(entry.tangent, b.dim) =
              expected.H.middleCols(b.offset, b.dim);
        }
      }
      for (const int g : factor.globals()) {
        const Block& b = blocks.globals()[static_cast<std::size_t>(g)].block;
        H.middleCols(column, b.dim) = expected.H.middleCols(b.offset, b.dim);
        column += b.dim;
      }
      EXPECT_LT((J.transpose() * J - H.transpose() * R_inverse * H).norm(),
                1e-12 * (J.transpose() * J).norm());
      EXPECT_LT(
          (J.transpose() * r + H.transpose() * R_inverse * expected.residual)
              .norm(),
          1e-9 * (J.transpose() * r).norm());
    }
  }
}

TEST(MeasurementFactor, JacobianMatchesNumericDifference) {
  for (const bool rich : {false, true}) {
    TestProblem problem = ShortDrive(rich, true);
    for (const std::size_t i : {4u, 5u}) {
      problem.measurements[i] = Correlated(problem, i);
    }
    const Timeline timeline = problem.MakeTimeline();
    const StateBlocks blocks(problem.layout);
    for (const std::size_t i : {4u, 5u}) {
      const Measurement& z = timeline.all_measurements()[i];
      const MeasurementFactor factor(&blocks, &timeline, 2, &z);
      ExpectJacobian(blocks, factor, {PairAt(problem, 2)[0]},
                     i == 4 ? "position" : "velocity");
    }
  }
}

TEST(PriorFactor, CostIsTheMahalanobisDistanceAndJacobianNumeric) {
  for (const bool walk : {false, true}) {
    const TestProblem problem = ShortDrive(true, walk);
    const StateBlocks blocks(problem.layout);
    Random random(5);
    Eigen::MatrixXd A(problem.layout.dim(), problem.layout.dim());
    for (double& value : A.reshaped()) value = 0.2 * random.Normal();
    A.diagonal().array() += 1.0;
    const ErrorMatrix P = A * problem.prior.P * A.transpose();
    const PriorFactor factor(&blocks, problem.prior.x, P);
    const State x = PairAt(problem, 0)[0];
    const ErrorVector d = Local(problem.layout, problem.prior.x, x);
    const Eigen::VectorXd s = P.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::VectorXd scaled = s.cwiseProduct(d);
    const Eigen::MatrixXd correlation = s.asDiagonal() * P * s.asDiagonal();
    const double expected = scaled.dot(correlation.fullPivLu().solve(scaled));
    EXPECT_NEAR(Point(blocks, factor, {x}).Residual().squaredNorm() / expected,
                1.0, 1e-7);
    ExpectJacobian(blocks, factor, {x}, "prior");
  }
}

TEST(Whitener, TurnsItsCovarianceIntoIdentity) {
  Eigen::Matrix3d S;
  S << 4.0, 2.0, 0.6, 2.0, 3.0, -0.4, 0.6, -0.4, 1.0;
  const Eigen::MatrixXd W = Whitener(S);
  EXPECT_TRUE((W * S * W.transpose()).isIdentity(1e-14));
  // Its transpose in its place would fail here.
  EXPECT_FALSE((W.transpose() * S * W).isIdentity(1e-2));
  S(2, 2) = -1.0;
  EXPECT_THROW(Whitener(S), EstimationError);
}

}  // namespace
}  // namespace hindsight
