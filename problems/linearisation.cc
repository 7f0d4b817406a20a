#include "problems/linearisation.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/units.h"

namespace hindsight {
namespace {

constexpr double kFarOff = 3.0;  // sigmas

}  // namespace

double LargestTurn(const std::vector<State>& a, const std::vector<State>& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    largest = std::max(largest, a[k].q_eb.angularDistance(b[k].q_eb));
  }
  return largest;
}

double DistanceInSigmas(const ErrorLayout& layout,
                        const std::vector<State>& solution,
                        const CovarianceSeries& P,
                        const std::vector<State>& states) {
  constexpr BlockKind kJudged[] = {BlockKind::kPosition, BlockKind::kVelocity,
                                   BlockKind::kAttitude};
  double square[std::size(kJudged)] = {};
  for (std::size_t k = 0; k < solution.size(); ++k) {
    const ErrorVector d = Local(layout, solution[k], states[k]);
    const ErrorMatrix P_k = P.Get(k);
    for (std::size_t i = 0; i < std::size(kJudged); ++i) {
      const Block* block = layout.Find(kJudged[i]);
      if (block == nullptr || block->dim == 0) continue;
      const Eigen::VectorXd d_i = d.segment(block->offset, block->dim);
      const Eigen::MatrixXd P_i =
          P_k.block(block->offset, block->offset, block->dim, block->dim);
      square[i] += d_i.dot(P_i.llt().solve(d_i)) / block->dim;
    }
  }
  const double largest =
      *std::max_element(std::begin(square), std::end(square));
  return std::sqrt(largest / static_cast<double>(solution.size()));
}

std::string LinearisedTooFarOff(Method method, const Solution& solution,
                                const std::optional<Relinearised>& anew) {
  const bool smoother = method == Method::kRts ||
                        method == Method::kTwoFilter ||
                        method == Method::kTwoFilterConventional ||
                        method == Method::kTwoFilterEuler;
  if (!anew || (!smoother && method != Method::kEkf)) return "";
  if (anew->smoother_sigmas <= kFarOff) return "";
  const double sigmas =
      anew->states.empty()
          ? anew->smoother_sigmas
          : DistanceInSigmas(solution.layout, solution.states,
                             solution.covariances, anew->states);
  if (sigmas <= kFarOff) return "";
  char words[200];
  std::snprintf(words, sizeof(words),
                "linearised up to %.0f deg off; linearised anew the result "
                "moves by %.2g of its sigmas (limit %.0f): take iterated or "
                "batch",
                anew->turn / kDegree, sigmas, kFarOff);
  return words;
}

}  // namespace hindsight
