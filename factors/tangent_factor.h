#ifndef HINDSIGHT_FACTORS_TANGENT_FACTOR_H_
#define HINDSIGHT_FACTORS_TANGENT_FACTOR_H_

#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <vector>

#include "factors/state_blocks.h"

namespace hindsight {

/// Base of all factors. A factor works in the tangent of the state (Retract of
/// state/state.h): it linearises its residual, whitened, over the components
/// of one or two nodes and of some global blocks. From that one Linearize come
/// Ceres's Jacobians (through the manifold's MinusJacobian) and the information
/// matrix of the marginal covariances.
///
/// Parameter blocks: the nodes, then the globals named in `globals`.
class TangentFactor : public ceres::CostFunction {
 public:
  /// Columns: node tangents in order, then the globals' in order.
  using Jacobian =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// `blocks` must outlive the factor; `globals` are numbers in
  /// StateBlocks::globals().
  TangentFactor(const StateBlocks* blocks, int rows, std::vector<int> nodes,
                std::vector<int> globals);

  /// Node numbers in the chain and global numbers that the factor touches.
  const std::vector<int>& nodes() const { return nodes_; }
  const std::vector<int>& globals() const { return globals_; }
  int tangent_dim() const { return tangent_dim_; }

  /// Whitened residual and, unless null, its tangent Jacobian.
  void Linearize(double const* const* parameters, double* residual,
                 Jacobian* J) const;

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const final;

  /// Has what does not depend on the values worked out and kept, for a factor that is
  /// linearised more than once. Throws EstimationError if its noise has no square
  /// root, as else Linearize does.
  virtual void Keep() {}

 protected:
  /// Residual and Jacobian (already sized and zero) over states whose globals
  /// are filled in; implementations whiten.
  virtual void LinearizeStates(const std::vector<State>& states,
                               Eigen::Map<Eigen::VectorXd> residual,
                               Jacobian* J) const = 0;
  /// Time of the i-th node [s].
  virtual double NodeTime(int i) const = 0;

  const StateBlocks& blocks() const { return blocks_; }
  /// First column of a block of the layout for the i-th node, or -1 if the
  /// factor has no such parameter block.
  int ColumnOf(const StateBlocks::Entry& entry, int i) const;

 private:
  const StateBlocks& blocks_;
  std::vector<int> nodes_;
  std::vector<int> globals_;
  std::vector<int> global_column_;  // by global number, -1: not touched
  int tangent_dim_ = 0;
};

/// W with W' W = S^-1, that is the inverse of the lower Cholesky factor of S:
/// whitened residual W r has unit covariance. The one place where information
/// is turned into a square root. Throws EstimationError if S is not positive
/// definite.
Eigen::MatrixXd Whitener(const Eigen::Ref<const Eigen::MatrixXd>& S);

/// A lower triangle, row by row: half of the memory of its matrix.
class PackedTriangle {
 public:
  explicit PackedTriangle(const Eigen::MatrixXd& L) : rows_(L.rows()) {
    values_.reserve(static_cast<std::size_t>(rows_ * (rows_ + 1) / 2));
    for (Eigen::Index r = 0; r < rows_; ++r) {
      for (Eigen::Index c = 0; c <= r; ++c) values_.push_back(L(r, c));
    }
  }
  Eigen::Index rows() const { return rows_; }
  double operator()(Eigen::Index r, Eigen::Index c) const {
    return values_[static_cast<std::size_t>(r * (r + 1) / 2 + c)];
  }

 private:
  Eigen::Index rows_;
  std::vector<double> values_;
};

/// residual = W residual and, unless null, J = W J, for such a W.
void Whiten(const Eigen::MatrixXd& W, Eigen::Map<Eigen::VectorXd> residual,
            TangentFactor::Jacobian* J);
void Whiten(const PackedTriangle& W, Eigen::Map<Eigen::VectorXd> residual,
            TangentFactor::Jacobian* J);

}  // namespace hindsight

#endif  // HINDSIGHT_FACTORS_TANGENT_FACTOR_H_
