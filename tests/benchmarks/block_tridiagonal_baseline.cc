#include <Eigen/Cholesky>
#include <cmath>
#include <stdexcept>

#include "benchmarks/baselines.h"
#include "benchmarks/last_step.h"
#include "problems/chain_problem.h"

namespace hindsight {
namespace {

constexpr int kDim = 15;
using Square = Eigen::Matrix<double, kDim, kDim>;
using Column = Eigen::Matrix<double, kDim, 1>;

/// H dx = -g: H has `diagonal` and, below it, `below` [k] = H(k + 1, k). The
/// factorisation L L' takes their place: L's diagonal blocks and those below.
struct NormalEquations {
  explicit NormalEquations(std::size_t nodes)
      : diagonal(nodes), below(nodes), g(nodes) {}
  std::vector<Square> diagonal;
  std::vector<Square> below;
  std::vector<Column> g;
};

/// Rows are at most those of a link.
void AddFactor(const TangentFactor::Jacobian& J, const Column& residual,
               const TangentFactor& factor, NormalEquations* normal) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, kDim, 0, kDim, kDim>;
  const auto k = static_cast<std::size_t>(factor.nodes().front());
  const Rows J0 = J.leftCols<kDim>();
  const auto r = residual.head(factor.num_residuals());
  normal->diagonal[k].noalias() += J0.transpose() * J0;
  normal->g[k].noalias() += J0.transpose() * r;
  if (factor.nodes().size() < 2) return;
  const Rows J1 = J.rightCols<kDim>();
  normal->below[k].noalias() += J1.transpose() * J0;
  normal->diagonal[k + 1].noalias() += J1.transpose() * J1;
  normal->g[k + 1].noalias() += J1.transpose() * r;
}

void Linearize(ChainProblem* chain, NormalEquations* normal) {
  for (auto* blocks : {&normal->diagonal, &normal->below}) {
    for (Square& block : *blocks) block.setZero();
  }
  for (Column& g : normal->g) g.setZero();
  TangentFactor::Jacobian J;
  Column residual;
  for (const auto& factor : chain->factors()) {
    const std::vector<double*> parameters = chain->ParametersOf(*factor);
    factor->Linearize(parameters.data(), residual.data(), &J);
    AddFactor(J, residual, *factor, normal);
  }
}

/// Leaves the factorisation, and in g the step.
void Solve(NormalEquations* normal) {
  const std::size_t nodes = normal->diagonal.size();
  for (std::size_t k = 0; k < nodes; ++k) {
    Square& L = normal->diagonal[k];
    const Eigen::LLT<Eigen::Ref<Square>> llt(L);
    if (llt.info() != Eigen::Success) {
      throw std::runtime_error("the normal equations are not definite");
    }
    L.triangularView<Eigen::Lower>().solveInPlace(normal->g[k]);
    if (k + 1 == nodes) break;
    Square& W = normal->below[k];
    L.triangularView<Eigen::Lower>()
        .transpose()
        .solveInPlace<Eigen::OnTheRight>(W);
    normal->diagonal[k + 1].noalias() -= W * W.transpose();
    normal->g[k + 1].noalias() -= W * normal->g[k];
  }
  for (std::size_t k = nodes; k-- > 0;) {
    Column& x = normal->g[k];
    // In g stands the solution of L y = g; the step is that of L' x = -y.
    x = -x;
    if (k + 1 < nodes) {
      x.noalias() -= normal->below[k].transpose() * normal->g[k + 1];
    }
    normal->diagonal[k].triangularView<Eigen::Lower>().transpose().solveInPlace(
        x);
  }
}

CovarianceSeries Marginals(const NormalEquations& normal) {
  const std::size_t nodes = normal.diagonal.size();
  CovarianceSeries series(kDim, nodes);
  Square P = Square::Zero();
  for (std::size_t k = nodes; k-- > 0;) {
    Square inverse = Square::Identity();
    const auto L = normal.diagonal[k].triangularView<Eigen::Lower>();
    L.solveInPlace(inverse);
    Square own;
    own.noalias() = inverse.transpose() * inverse;
    if (k + 1 < nodes) {
      Square G;
      G.noalias() = normal.below[k] * inverse;
      Square PG;
      PG.noalias() = P * G;
      own.noalias() += G.transpose() * PG;
    }
    P = own;
    series.Set(k, P);
  }
  return series;
}

}  // namespace

BaselineResult SolveBlockTridiagonal(const std::vector<State>& initial,
                                     Problem* problem) {
  constexpr int kMaxIterations = 50;
  ChainProblem chain(initial, problem);
  chain.KeepFactors();
  if (chain.blocks().node_dim() != kDim || chain.blocks().global_dim() != 0) {
    throw std::logic_error("the baseline knows 15 unknowns a node alone");
  }
  const NodeManifold manifold(&chain.blocks());
  NormalEquations normal(chain.node_count());
  BaselineResult result;
  double size = 0.0;
  do {
    Linearize(&chain, &normal);
    Solve(&normal);
    double sum = 0.0;
    for (std::size_t k = 0; k < chain.node_count(); ++k) {
      manifold.Plus(chain.node_values(k), normal.g[k].data(),
                    chain.node_values(k));
      sum += normal.g[k].squaredNorm();
    }
    size = std::sqrt(sum / static_cast<double>(chain.node_count()));
  } while (++result.iterations < kMaxIterations && size > kLastStep);
  result.P = Marginals(normal);
  result.states = chain.States();
  return result;
}

}  // namespace hindsight
