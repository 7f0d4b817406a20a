#ifndef HINDSIGHT_LINEAR_ARROW_LEAST_SQUARES_H_
#define HINDSIGHT_LINEAR_ARROW_LEAST_SQUARES_H_

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "base/paged_rows.h"
#include "linear/householder.h"

namespace hindsight {

/// An unknown that the rows do not determine: after elimination of the unknowns
/// before it, nothing but rounding is left of its column. It stays undetermined
/// even if all unknowns after it are known.
struct Deficiency {
  static constexpr int kBorder = -1;
  int node = kBorder;
  int component = 0;
  /// What elimination leaves of the column's norm, as a fraction of it.
  double relative_pivot = 0.0;
};

/// Linear least squares, the minimum of ||r + J x||^2 over rows of unit
/// covariance, on a chain of K nodes with n unknowns each and a border of m
/// unknowns that all rows may share. Each row sees one node, or a node and the
/// next, and the border.
///
/// J = Q R by Householder reflections, a node at a time (Golub and Van Loan,
/// Matrix Computations, 5.2; as a filter, the square-root information filter of
/// Bierman 1977, ch. 5): R has the shape of the rows, so that factorisation,
/// solution and the covariances inside the shape take time and memory linear in
/// K (the selected inverse of Takahashi, Fagan and Chin 1973, on blocks).
/// J'J is never formed. It would leave of a solution and its covariances about
/// 1e-16 / q, where q is the smallest ratio of a link's variance to the variance
/// of the unknown that it links: nothing for a position known to 10 m and nodes
/// of an IMU that are 40 ms apart, q = 1e-15. Here the loss goes with sqrt(q).
///
/// Use: add all rows, the nodes in ascending order, then Solve, then read the
/// rest any number of times. Calls out of this order throw std::logic_error.
/// Memory: K (2 n + m + 1) (n + 1) doubles, of which long chains hold little
/// (PagedRows).
class ArrowLeastSquares {
 public:
  using RowMatrix =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using ConstBlock = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
  using ConstSegment = Eigen::VectorBlock<const Eigen::VectorXd>;

  /// nodes >= 1, node_dim >= 1, border_dim >= 0. An unknown of whose column
  /// elimination leaves the fraction `tolerance` or less (or no number) is held
  /// fixed.
  ArrowLeastSquares(int nodes, int node_dim, int border_dim,
                    double tolerance = 1e-14);

  int nodes() const { return nodes_; }
  int node_dim() const { return n_; }
  int border_dim() const { return m_; }

  /// Rows that see one node or two, all zero, to be filled by the caller until
  /// the next call.
  class Rows {
   public:
    /// Columns of the node, of the next one (of rows that see two), and of the
    /// border.
    Eigen::Block<RowMatrix> node() { return Columns(0, n_); }
    Eigen::Block<RowMatrix> next() { return Columns(n_ + m_ + 1, n_); }
    Eigen::Block<RowMatrix> border() { return Columns(n_, m_); }
    /// r, the residuals where the unknowns are zero.
    Eigen::Block<RowMatrix> residual() { return Columns(n_ + m_, 1); }

   private:
    friend class ArrowLeastSquares;
    Rows(RowMatrix* rows, Eigen::Index first, int count, int n, int m)
        : rows_(*rows), first_(first), count_(count), n_(n), m_(m) {}
    Eigen::Block<RowMatrix> Columns(int column, int columns) {
      return rows_.block(first_, column, count_, columns);
    }
    RowMatrix& rows_;
    Eigen::Index first_;
    int count_, n_, m_;
  };
  /// `count` rows that see node k and the border. k is not below that of any
  /// call before.
  Rows AddToNode(int k, int count);
  /// `count` rows that see nodes k and k + 1 < nodes(), and the border.
  Rows AddToLink(int k, int count);

  /// Factors and solves. Returns the unknowns that are held fixed, of which
  /// solution, variance and covariances are zero. The order of elimination is
  /// 0 ... K - 1, border, so an undetermined direction shared by many nodes is
  /// reported at the last of them.
  std::vector<Deficiency> Solve();

  /// The solution.
  ConstSegment x(int k) const { return solution_.segment(k * n_, n_); }
  ConstSegment x_border() const { return solution_.tail(m_); }

  /// Blocks of the covariance (J'J)^-1. Those that do not exist have no elements.
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

  /// Border block of the covariance, m x m.
  Eigen::MatrixXd BorderCovariance() const;

 private:
  enum class Phase { kFilling, kSolved };

  double* Panel(int k) { return panels_.Row(static_cast<std::size_t>(k)); }
  const double* Panel(int k) const {
    return panels_.Row(static_cast<std::size_t>(k));
  }
  void Require(Phase phase, const char* call) const;
  Rows Add(int k, int count, RowMatrix* rows, Eigen::Index* used);
  void CountNorms();
  /// Whether unknown j of the node, of which that norm is left, is held fixed.
  bool IsFixed(Eigen::Index j, double left);
  /// Row j of such an unknown may still tell others: puts it behind `to`.
  void PassOn(Eigen::Index j, RowMatrix* to, Eigen::Index* used);
  void EliminateNode();
  // Its steps: the rows that see the node alone, what is left of them, which
  // sees the border alone, and the rows that see the next node too.
  void TriangulariseNode();
  void GiveToBorder();
  void TakeLink();
  void EliminateBorder();
  void Carry();

  int nodes_;
  int n_;
  int m_;
  double tolerance_;
  // Leading dimensions: even, so that every column starts on 16 bytes. Rows
  // beyond the true dimension stay zero.
  int node_rows_;
  int border_rows_;
  int height_;
  Phase phase_ = Phase::kFilling;
  // The node that is being filled; columns of its rows: node, border, r, next
  // node. The first `carried_` rows are what eliminating the node before left.
  int filled_ = 0;
  RowMatrix node_work_;
  RowMatrix link_work_;
  Eigen::Index carried_ = 0;
  Eigen::Index node_used_ = 0;
  Eigen::Index link_used_ = 0;
  // Triangle of the border; columns: border, r.
  RowMatrix border_work_;
  // Squared norms of the columns of J.
  Eigen::RowVectorXd node_norm_;
  Eigen::RowVectorXd next_norm_;
  Eigen::RowVectorXd border_norm_;
  // Column j of panel k is row j of R: its columns of node k, node k + 1 and
  // border. Column-major, contiguous.
  PagedRows panels_;
  Eigen::VectorXd border_;
  Eigen::VectorXd solution_;
  // Reciprocals of R's diagonal, 0 for an unknown held fixed.
  Eigen::VectorXd inverse_diagonal_;
  std::vector<Deficiency> deficient_;
  Householder householder_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_LINEAR_ARROW_LEAST_SQUARES_H_
