#include "factors/prior_factor.h"

#include <Eigen/LU>
#include <numeric>

namespace hindsight {
namespace {

std::vector<int> AllGlobals(const StateBlocks& blocks) {
  std::vector<int> globals(blocks.globals().size());
  std::iota(globals.begin(), globals.end(), 0);
  return globals;
}

}  // namespace

PriorFactor::PriorFactor(const StateBlocks* blocks, const State& prior,
                         const ErrorMatrix& P)
    : TangentFactor(blocks, blocks->layout().dim(), {0}, AllGlobals(*blocks)),
      prior_(prior),
      whitener_(Whitener(P)) {}

void PriorFactor::LinearizeStates(const std::vector<State>& states,
                                  Eigen::Map<Eigen::VectorXd> residual,
                                  Jacobian* J) const {
  const ErrorLayout& layout = blocks().layout();
  const ErrorVector d = Local(layout, prior_, states[0]);
  residual = whitener_.triangularView<Eigen::Lower>() * d;
  if (J == nullptr) return;
  // d Local(prior, x [+] e)/d e is the inverse of the transport to x.
  const ErrorMatrix T = Transport(layout, prior_, states[0]);
  const Eigen::MatrixXd WT =
      whitener_.triangularView<Eigen::Lower>() * T.inverse();
  for (const StateBlocks::Entry& entry : blocks().entries()) {
    const int dim = entry.block.dim;
    J->middleCols(ColumnOf(entry, 0), dim) =
        WT.middleCols(entry.block.offset, dim);
  }
}

}  // namespace hindsight
