#include "problems/linearisation.h"

#include <cmath>

namespace hindsight {

LinearisationMove LargestMove(const ErrorLayout& layout,
                              const std::vector<State>& from,
                              const CovarianceSeries& P,
                              const std::vector<State>& states) {
  LinearisationMove move;
  for (std::size_t k = 0; k < from.size(); ++k) {
    const ErrorVector d = Local(layout, from[k], states[k]);
    const ErrorVector variance = P.Get(k).diagonal();
    for (const Block& block : layout.blocks()) {
      if (block.key.kind > BlockKind::kAttitude) continue;
      for (int i = block.offset; i < block.offset + block.dim; ++i) {
        const double sigmas = std::abs(d(i)) / std::sqrt(variance(i));
        if (!(sigmas > move.sigmas)) continue;
        move.sigmas = sigmas;
        move.component = layout.ComponentName(i);
        move.t = from[k].t;
      }
    }
  }
  return move;
}

std::optional<LinearisationMove> MoveOf(Method method, const Solution& solution,
                                        const Relinearised& anew) {
  switch (method) {
    case Method::kRts:
    case Method::kTwoFilter:
    case Method::kTwoFilterConventional:
    case Method::kTwoFilterEuler:
      break;
    case Method::kEkf:
      if (anew.smoother.sigmas < kDoubtfulBias) return std::nullopt;
      break;
    default:
      return std::nullopt;
  }
  if (anew.states.empty()) return anew.smoother;
  LinearisationMove move = LargestMove(solution.layout, solution.states,
                                       solution.covariances, anew.states);
  move.settled = anew.smoother.settled;
  return move;
}

}  // namespace hindsight
