#include "problems/disagreement.h"

#include <fmt/core.h>

#include <cmath>

namespace hindsight {

bool OptimumComparison::HasNodesOf(const Solution& solution) const {
  constexpr double kSameTime = 1e-9;
  if (poses_.size() != solution.states.size()) return false;
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    if (std::abs(poses_[k].t - solution.states[k].t) > kSameTime) return false;
  }
  return true;
}

std::optional<Evidence> OptimumComparison::Compare(const std::string& method,
                                                   const Solution& solution) {
  constexpr double kLimit = 1.0;  // sigma
  if (!solution.converged || solution.covariances.empty()) return std::nullopt;
  if (!HasNodesOf(solution)) {
    method_ = method;
    poses_.clear();
    for (const State& x : solution.states) {
      poses_.push_back({x.t, x.p_e, x.q_eb});
    }
    return std::nullopt;
  }
  double largest = 0.0;
  double t = 0.0;
  std::string component;
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    State other = solution.states[k];
    other.p_e = poses_[k].p_e;
    other.q_eb = poses_[k].q_eb;
    const ErrorVector d = Local(solution.layout, solution.states[k], other);
    const ErrorMatrix P = solution.covariances.Get(k);
    for (const Block& block : solution.layout.blocks()) {
      if (block.key.kind != BlockKind::kPosition &&
          block.key.kind != BlockKind::kAttitude) {
        continue;
      }
      for (int i = block.offset; i < block.offset + block.dim; ++i) {
        const double sigmas = std::abs(d(i)) / std::sqrt(P(i, i));
        if (!(sigmas > largest)) continue;
        largest = sigmas;
        t = other.t;
        component = solution.layout.ComponentName(i);
      }
    }
  }
  if (!(largest > kLimit)) return std::nullopt;
  return Evidence{
      .rule = "disagreement",
      .grade = Grade::kDoubtful,
      .what = fmt::format(
          "{} and {} end {:.2g} sigma apart in {} at {:.1f} s (limit 1)",
          method_, method, largest, component, t),
      .value = largest,
      .limit = kLimit,
      .unit = "sigma",
      .t_begin = t,
      .t_end = t,
      .causes = {"a start so uncertain, or data that say so little, that the "
                 "cost has several minima"},
      .remedies = {"a better known start"},
      .against = method_};
}

}  // namespace hindsight
