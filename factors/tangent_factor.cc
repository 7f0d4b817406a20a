#include "factors/tangent_factor.h"

#include <Eigen/Cholesky>
#include <utility>

#include "base/error.h"
#include "geometry/so3.h"

namespace hindsight {

// Debian compiles Ceres for every x86-64, where Eigen aligns to 16 bytes and
// leaves that to malloc: what is taken here may be freed there. An -march with
// AVX alone would change both.
static_assert(EIGEN_MAX_STATIC_ALIGN_BYTES <= 16 &&
                  EIGEN_MALLOC_ALREADY_ALIGNED,
              "Eigen must align memory as Ceres does: see the preset "
              "release-v3");

TangentFactor::TangentFactor(const StateBlocks* blocks, int rows,
                             std::vector<int> nodes, std::vector<int> globals)
    : blocks_(*blocks),
      nodes_(std::move(nodes)),
      globals_(std::move(globals)),
      global_column_(blocks->globals().size(), -1) {
  set_num_residuals(rows);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    mutable_parameter_block_sizes()->push_back(blocks_.node_ambient_dim());
    tangent_dim_ += blocks_.node_dim();
  }
  for (const int g : globals_) {
    const int dim = FullDimension(
        blocks_.globals()[static_cast<std::size_t>(g)].block.key.kind);
    mutable_parameter_block_sizes()->push_back(dim);
    global_column_[static_cast<std::size_t>(g)] = tangent_dim_;
    tangent_dim_ += dim;
  }
}

int TangentFactor::ColumnOf(const StateBlocks::Entry& entry, int i) const {
  if (entry.global) {
    return global_column_[static_cast<std::size_t>(entry.ambient)];
  }
  return i * blocks_.node_dim() + entry.tangent;
}

void TangentFactor::Linearize(double const* const* parameters, double* residual,
                              Jacobian* J) const {
  std::vector<const double*> globals(blocks_.globals().size(), nullptr);
  for (std::size_t i = 0; i < globals_.size(); ++i) {
    globals[static_cast<std::size_t>(globals_[i])] =
        parameters[nodes_.size() + i];
  }
  std::vector<State> states;
  states.reserve(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    states.push_back(blocks_.ReadState(NodeTime(static_cast<int>(i)),
                                       parameters[i], globals));
  }
  if (J != nullptr) J->setZero(num_residuals(), tangent_dim_);
  LinearizeStates(states,
                  Eigen::Map<Eigen::VectorXd>(residual, num_residuals()), J);
}

bool TangentFactor::Evaluate(double const* const* parameters, double* residuals,
                             double** jacobians) const {
  if (jacobians == nullptr) {
    Linearize(parameters, residuals, nullptr);
    return true;
  }
  thread_local Jacobian J;
  Linearize(parameters, residuals, &J);
  const int rows = num_residuals();
  const int n = blocks_.node_dim();
  const int ambient = blocks_.node_ambient_dim();
  using Output = Eigen::Map<Jacobian>;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (jacobians[i] == nullptr) continue;
    const double* x = parameters[i];
    const Eigen::Matrix3d C_ne =
        NedAxes(Eigen::Map<const Eigen::Vector3d>(x)).transpose();
    const Eigen::Matrix<double, 3, 4> log_q =
        4.0 * C_ne *
        LeftPlusJacobian(Eigen::Map<const Eigen::Quaterniond>(x + 6))
            .transpose();
    const auto J_i = J.middleCols(static_cast<Eigen::Index>(i) * n, n);
    Output out(jacobians[i], rows, ambient);
    out.leftCols<3>().noalias() = J_i.leftCols<3>() * C_ne;
    out.middleCols<3>(3).noalias() = J_i.middleCols<3>(3) * C_ne;
    out.middleCols<4>(6).noalias() = J_i.middleCols<3>(6) * log_q;
    out.rightCols(ambient - 10) = J_i.rightCols(n - 9);
  }
  for (std::size_t i = 0; i < globals_.size(); ++i) {
    double* jacobian = jacobians[nodes_.size() + i];
    if (jacobian == nullptr) continue;
    const int column = global_column_[static_cast<std::size_t>(globals_[i])];
    const int dim = parameter_block_sizes()[nodes_.size() + i];
    Output(jacobian, rows, dim) = J.middleCols(column, dim);
  }
  return true;
}

Eigen::MatrixXd Whitener(const Eigen::Ref<const Eigen::MatrixXd>& S) {
  const Eigen::LLT<Eigen::MatrixXd> llt(S);
  if (llt.info() != Eigen::Success) {
    throw EstimationError("covariance of a factor is not positive definite");
  }
  return llt.matrixL().solve(Eigen::MatrixXd::Identity(S.rows(), S.cols()));
}

namespace {

/// From the last row to the first, so that each is made of rows still as they
/// were. Most of W is zero where biases walk apart from each other.
template <typename Triangle>
void MultiplyRows(const Triangle& W, Eigen::Index columns, double* M) {
  for (Eigen::Index r = W.rows() - 1; r >= 0; --r) {
    double* row = M + r * columns;
    for (Eigen::Index j = 0; j < columns; ++j) row[j] *= W(r, r);
    for (Eigen::Index c = 0; c < r; ++c) {
      const double factor = W(r, c);
      if (factor == 0.0) continue;
      const double* other = M + c * columns;
      for (Eigen::Index j = 0; j < columns; ++j) row[j] += factor * other[j];
    }
  }
}

}  // namespace

void Whiten(const Eigen::MatrixXd& W, Eigen::Map<Eigen::VectorXd> residual,
            TangentFactor::Jacobian* J) {
  MultiplyRows(W, 1, residual.data());
  if (J != nullptr) MultiplyRows(W, J->cols(), J->data());
}

void Whiten(const PackedTriangle& W, Eigen::Map<Eigen::VectorXd> residual,
            TangentFactor::Jacobian* J) {
  MultiplyRows(W, 1, residual.data());
  if (J != nullptr) MultiplyRows(W, J->cols(), J->data());
}

}  // namespace hindsight
