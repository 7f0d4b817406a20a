#ifndef HINDSIGHT_LINEAR_ARROW_SYSTEM_H_
#define HINDSIGHT_LINEAR_ARROW_SYSTEM_H_

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace hindsight {

/// An unknown that the system does not determine: after elimination of the
/// unknowns before it, its pivot is zero but for rounding. It stays
/// undetermined even if all unknowns after it are known.
struct Deficiency {
  static constexpr int kBorder = -1;
  int node = kBorder;
  int component = 0;
  /// What elimination leaves of the diagonal element, as a fraction of it.
  double relative_pivot = 0.0;
};

/// Symmetric positive definite system Lambda x = b of a chain of K nodes with n
/// unknowns each, bordered by m unknowns that all nodes may share:
///
///              | D_0  E_0'          B_0' |
///     Lambda = | E_0  D_1  E_1'     B_1' |
///              |      E_1  D_2 ...  ...  |
///              | B_0  B_1  ...      C    |
///
/// Lambda = L L' has the same shape, so that factorisation, solution and the
/// covariances inside the shape all take time and memory linear in K
/// (Golub and Van Loan, Matrix Computations, 4.5; the selected inverse is
/// Takahashi, Fagan and Chin 1973 on blocks).
///
/// Accuracy: about 1e-16 / q of the solution and the covariances, where q is
/// the smallest ratio of a link's variance to the variance of the unknown it
/// links (1e-6 still leaves nine digits). What hardly changes along the chain
/// belongs in the border.
///
/// Use: fill the blocks and the right side, Factor, then Solve and
/// VisitMarginals any number of times, in any order. Calls out of this order
/// throw std::logic_error. Memory: K (2 n + m + 1) (n + 1) doubles.
class ArrowSystem {
 public:
  using Block = Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
  using ConstBlock = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
  using Segment = Eigen::VectorBlock<Eigen::VectorXd>;
  using ConstSegment = Eigen::VectorBlock<const Eigen::VectorXd>;

  /// All elements zero. nodes >= 1, node_dim >= 1, border_dim >= 0.
  ArrowSystem(int nodes, int node_dim, int border_dim);

  int nodes() const { return nodes_; }
  int node_dim() const { return n_; }
  int border_dim() const { return m_; }

  /// Back to all zero, to be filled anew.
  void SetZero();

  /// D_k, n x n; only the lower triangle is read.
  Block node(int k);
  /// E_k, n x n: rows of node k + 1, columns of node k; k < nodes() - 1.
  Block coupling(int k);
  /// B_k, m x n: rows of the border, columns of node k.
  Block border_coupling(int k);
  /// C, m x m; only the lower triangle is read.
  Block border();

  /// Right side before Solve, solution after it.
  Segment rhs(int k) { return rhs_.segment(k * n_, n_); }
  ConstSegment rhs(int k) const { return rhs_.segment(k * n_, n_); }
  Segment rhs_border() { return rhs_.tail(m_); }
  ConstSegment rhs_border() const { return rhs_.tail(m_); }

  /// Replaces Lambda by its Cholesky factor, after scaling its diagonal to one.
  /// An unknown whose pivot falls to `tolerance` or below (or is not a number)
  /// is reported and held fixed: its solution, variance and covariances are
  /// zero. The order of elimination is 0 ... K - 1, border, so an undetermined
  /// direction shared by many nodes is reported at the last of them.
  std::vector<Deficiency> Factor(double tolerance = 1e-13);

  /// Replaces the right side by Lambda^-1 b.
  void Solve();

  /// Blocks of Lambda^-1. Those that do not exist have no elements.
  struct NodeMarginal {
    int node = 0;
    ConstBlock covariance;   ///< of node k, n x n
    ConstBlock next_node;    ///< of node k + 1 (rows) with node k, n x n
    ConstBlock border_node;  ///< of the border (rows) with node k, m x n
  };
  using MarginalVisitor = std::function<void(const NodeMarginal&)>;

  /// Calls `visit` for every node from the last to the first; the blocks live
  /// until it returns.
  void VisitMarginals(const MarginalVisitor& visit) const;

  /// Border block of Lambda^-1, m x m.
  Eigen::MatrixXd BorderCovariance() const;

 private:
  enum class Phase { kFilling, kFactored };

  double* Panel(int k) { return panels_.data() + PanelOffset(k); }
  const double* Panel(int k) const { return panels_.data() + PanelOffset(k); }
  Eigen::Index PanelOffset(int k) const {
    return static_cast<Eigen::Index>(k) * height_ * n_;
  }
  void Require(Phase phase, const char* call) const;
  void ScaleNode(int k);
  void ScalePanel(int k);
  void ScaleBorder();
  void EliminateNode(int k);

  int nodes_;
  int n_;
  int m_;
  // Leading dimensions: even, so that every column starts on 16 bytes. Rows
  // beyond the true dimension stay zero.
  int node_rows_;
  int border_rows_;
  int height_;
  Phase phase_ = Phase::kFilling;
  // Panel k is the column of blocks (D_k, E_k, B_k), column-major, contiguous.
  Eigen::VectorXd panels_;
  Eigen::VectorXd border_;
  Eigen::VectorXd rhs_;
  Eigen::VectorXd scale_;
  // Reciprocals of the factor's diagonal, 0 for an unknown held fixed.
  Eigen::VectorXd inverse_diagonal_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_LINEAR_ARROW_SYSTEM_H_
