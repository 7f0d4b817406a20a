#include "factors/attitude_factors.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/manifold.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "geometry/so3.h"

namespace hindsight {
namespace {

using Jacobian =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

const Eigen::Quaterniond kAttitude = Exp(Eigen::Vector3d(0.4, -0.7, 1.9));

Eigen::Matrix3d Whitening() {
  Eigen::Matrix3d W;
  W << 900.0, 0.0, 0.0, -120.0, 700.0, 0.0, 80.0, 60.0, 500.0;
  return W;
}

RotationResidual Rotation() {
  RotationResidual residual;
  residual.dR = Exp(Eigen::Vector3d(0.05, -0.03, 0.08));
  residual.R_bg = -0.1 * Eigen::Matrix3d::Identity() +
                  0.004 * Skew(Eigen::Vector3d(1.0, 2.0, -1.0));
  residual.R_sg = Eigen::Vector3d(-0.05, 0.03, -0.08).asDiagonal();
  residual.b_0 = {0.01, -0.02, 0.005};
  residual.earth = Exp(Eigen::Vector3d(2e-5, 0.0, -3e-5));
  residual.whitening = Whitening();
  residual.bias_sigma = 2e-4;
  return residual;
}

/// A block moved by d in its tangent; blocks of four are attitudes.
Eigen::VectorXd Moved(const Eigen::VectorXd& block, const Eigen::VectorXd& d) {
  if (block.size() != 4) return block + d;
  Eigen::VectorXd moved(4);
  EXPECT_TRUE(ceres::EigenQuaternionManifold().Plus(block.data(), d.data(),
                                                    moved.data()));
  return moved;
}

/// d residual / d tangent of block i, as the cost has it.
Jacobian TangentJacobian(const ceres::CostFunction& cost,
                         const std::vector<const double*>& blocks,
                         std::size_t i) {
  const int size = cost.parameter_block_sizes()[i];
  Jacobian J(cost.num_residuals(), size);
  std::vector<double*> jacobians(blocks.size(), nullptr);
  jacobians[i] = J.data();
  Eigen::VectorXd residual(cost.num_residuals());
  EXPECT_TRUE(cost.Evaluate(blocks.data(), residual.data(), jacobians.data()));
  if (size != 4) return J;
  Eigen::Matrix<double, 4, 3, Eigen::RowMajor> plus;
  EXPECT_TRUE(
      ceres::EigenQuaternionManifold().PlusJacobian(blocks[i], plus.data()));
  return J * plus;
}

/// Compares the derivatives with central differences in the tangent of every
/// block. A step of 1e-4 leaves its square of third derivatives.
void ExpectTrueJacobians(const ceres::CostFunction& cost,
                         std::vector<const double*> blocks) {
  constexpr double kStep = 1e-4;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const Jacobian J = TangentJacobian(cost, blocks, i);
    const double* const block = blocks[i];
    const Eigen::VectorXd at = Eigen::Map<const Eigen::VectorXd>(
        block, cost.parameter_block_sizes()[i]);
    const auto residual = [&](const Eigen::VectorXd& d) {
      const Eigen::VectorXd moved = Moved(at, d);
      blocks[i] = moved.data();
      Eigen::VectorXd r(cost.num_residuals());
      EXPECT_TRUE(cost.Evaluate(blocks.data(), r.data(), nullptr));
      blocks[i] = block;
      return r;
    };
    EXPECT_GT(J.cwiseAbs().maxCoeff(), 0.0);
    for (Eigen::Index c = 0; c < J.cols(); ++c) {
      const Eigen::VectorXd d = kStep * Eigen::VectorXd::Unit(J.cols(), c);
      const Eigen::VectorXd numeric =
          (residual(d) - residual(-d)) / (2.0 * kStep);
      EXPECT_LT((J.col(c) - numeric).cwiseAbs().maxCoeff(),
                1e-6 * J.cwiseAbs().maxCoeff())
          << "block " << i << ", column " << c;
    }
  }
}

TEST(AttitudeFactors, JacobiansMatchNumericDifferences) {
  const Eigen::Quaterniond q_j =
      Exp(Eigen::Vector3d(1e-3, 2e-3, -1e-3)) * kAttitude * Rotation().dR;
  const Eigen::Vector3d b_i(0.012, -0.018, 0.004), b_j(0.0121, -0.0181, 0.0042);
  const Eigen::Vector3d scale(0.002, -0.001, 0.003), d_i(1.0, -2.0, 0.5),
      d_j(0.8, -1.7, 0.9);
  const Eigen::Vector2d field(18.0, 44.0);
  const double declination = 0.07;
  const double* q = kAttitude.coeffs().data();
  using Turn = ceres::AutoDiffCostFunction<RotationResidual, 6, 4, 3, 4, 3, 3>;
  ExpectTrueJacobians(
      Turn(new RotationResidual(Rotation())),
      {q, b_i.data(), q_j.coeffs().data(), b_j.data(), scale.data()});
  using Gravity = ceres::AutoDiffCostFunction<GravityResidual, 2, 4>;
  ExpectTrueJacobians(
      Gravity(new GravityResidual{Eigen::Vector3d(1.0, -3.0, -9.0), 0.2}), {q});
  using Field = ceres::AutoDiffCostFunction<FieldResidual, 3, 4, 3, 2, 1>;
  ExpectTrueJacobians(
      Field(new FieldResidual{Eigen::Vector3d(12.0, -20.0, 38.0), 3.0}),
      {q, d_i.data(), field.data(), &declination});
  using Markov = ceres::AutoDiffCostFunction<MarkovResidual, 3, 3, 3>;
  ExpectTrueJacobians(Markov(new MarkovResidual{0.98, 0.4}),
                      {d_i.data(), d_j.data()});
  using Prior = ceres::AutoDiffCostFunction<AttitudePriorResidual, 3, 4>;
  ExpectTrueJacobians(Prior(new AttitudePriorResidual{
                          Exp(Eigen::Vector3d(0.01, -0.02, 0.03)) * kAttitude,
                          Eigen::Vector3d(0.05, 0.05, 0.2)}),
                      {q});
}

TEST(AttitudeFactors, NothingIsLeftAtTheTruth) {
  const Eigen::Quaterniond q_j =
      Rotation().earth.conjugate() * kAttitude * Rotation().dR;
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 6, 1> r;
  ASSERT_TRUE(Rotation()(kAttitude.coeffs().data(), Rotation().b_0.data(),
                         q_j.coeffs().data(), Rotation().b_0.data(),
                         none.data(), r.data()));
  EXPECT_LT(r.norm(), 1e-10);

  const Eigen::Vector3d d_n(1.0, -2.0, 0.5);
  const Eigen::Vector2d field(18.0, 44.0);
  const double declination = 0.07;
  const Eigen::Vector3d m_n(18.0 * std::cos(declination),
                            18.0 * std::sin(declination), 44.0);
  const FieldResidual reading{kAttitude.conjugate() * (m_n + d_n), 3.0};
  Eigen::Vector3d left;
  ASSERT_TRUE(reading(kAttitude.coeffs().data(), d_n.data(), field.data(),
                      &declination, left.data()));
  EXPECT_LT(left.norm(), 1e-12);

  const GravityResidual level{
      kAttitude.conjugate() * Eigen::Vector3d(0.0, 0.0, -9.8), 0.2};
  ASSERT_TRUE(level(kAttitude.coeffs().data(), left.data()));
  EXPECT_LT(left.head<2>().norm(), 1e-12);
}

/// A rotation d too much, resolved at the interval's end, costs (W d)' (W d).
TEST(AttitudeFactors, RotationIsWhitenedInBodyAxesAtTheEnd) {
  const Eigen::Vector3d d(3e-4, -2e-4, 1e-4);
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  const Eigen::Quaterniond q_j =
      Rotation().earth.conjugate() * kAttitude * Rotation().dR * Exp(d);
  Eigen::Matrix<double, 6, 1> r;
  ASSERT_TRUE(Rotation()(kAttitude.coeffs().data(), Rotation().b_0.data(),
                         q_j.coeffs().data(), Rotation().b_0.data(),
                         none.data(), r.data()));
  EXPECT_LT((r.head<3>() - Whitening() * d).norm(), 1e-7);
}

}  // namespace
}  // namespace hindsight
