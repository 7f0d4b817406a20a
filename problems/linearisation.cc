#include "problems/linearisation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "filters/forward_filter.h"

namespace hindsight {
namespace {

/// Calls `function` for each component of position, velocity and attitude that
/// the layout has: with its number among these nine, and its number in the
/// layout.
template <typename Function>
void ForEachNavigationComponent(const ErrorLayout& layout, Function function) {
  int i = 0;
  for (const Block& block : layout.blocks()) {
    if (block.key.kind > BlockKind::kAttitude) continue;
    for (int c = block.offset; c < block.offset + block.dim; ++c) {
      function(i++, c);
    }
  }
}

}  // namespace

std::vector<NavigationVariances> VariancesOf(const ErrorLayout& layout,
                                             const CovarianceSeries& P) {
  std::vector<NavigationVariances> variances(P.size(),
                                             NavigationVariances::Zero());
  for (std::size_t k = 0; k < P.size(); ++k) {
    const ErrorVector P_k = P.Variances(k);
    ForEachNavigationComponent(layout,
                               [&](int i, int c) { variances[k](i) = P_k(c); });
  }
  return variances;
}

double LargestDistance(const ErrorLayout& layout,
                       const std::vector<State>& from,
                       const std::vector<State>& to,
                       const std::vector<NavigationVariances>& variances) {
  double largest = 0.0;
  for (std::size_t k = 0; k < from.size(); ++k) {
    const ErrorVector d = Local(layout, from[k], to[k]);
    ForEachNavigationComponent(layout, [&](int i, int c) {
      largest = std::max(largest, std::abs(d(c)) / std::sqrt(variances[k](i)));
    });
  }
  return largest;
}

Rested SmoothUntilItRests(const std::vector<State>& states, Problem* problem,
                          const EpochCallback& callback) {
  constexpr int kMost = 4;
  // Of a step by the covariances before it that is surely none of those after it.
  constexpr double kPlainStep = 3.0 * Rested::kNegligibleStep;
  const ErrorLayout& layout = problem->layout;
  Rested rested{.trajectory = {}, .tape = LinearTape(layout)};
  std::vector<NavigationVariances> variances;
  do {
    const std::vector<State>& about =
        rested.passes == 0 ? states : rested.trajectory.states;
    rested.tape = RunLinearizedFilter(about, problem, callback);
    const bool may_go_on = ++rested.passes < kMost;
    if (may_go_on && !variances.empty()) {
      SmoothedTrajectory next = SmoothMeans(rested.tape);
      rested.step = LargestDistance(layout, about, next.states, variances);
      if (rested.step > kPlainStep) {
        rested.trajectory = std::move(next);
        continue;
      }
    }
    SmoothedTrajectory next = SmoothRts(rested.tape, {.errors = false});
    variances = VariancesOf(layout, next.P);
    rested.step = LargestDistance(layout, about, next.states, variances);
    if (rested.passes == 1) rested.first = rested.step;
    rested.trajectory = std::move(next);
  } while (rested.passes < kMost && !rested.is_settled());
  return rested;
}

LinearisationError Compare(const ErrorLayout& layout,
                           const std::vector<State>& states,
                           const CovarianceSeries& P,
                           const Relinearised& anew) {
  LinearisationError error;
  double largest = 0.0;
  NavigationVariances sum = NavigationVariances::Zero();
  for (std::size_t k = 0; k < states.size(); ++k) {
    const ErrorVector d = Local(layout, states[k], anew.states[k]);
    const ErrorVector P_k = P.Variances(k);
    ForEachNavigationComponent(layout, [&](int i, int c) {
      const double square = (d(c) * d(c) + anew.variances[k](i)) / P_k(c);
      sum(i) += square;
      if (!(square > largest)) return;
      largest = square;
      error.component = layout.ComponentName(c);
      error.t = states[k].t;
    });
  }
  error.largest = std::sqrt(largest);
  double worst = 0.0;
  ForEachNavigationComponent(layout, [&](int i, int c) {
    if (!(sum(i) > worst)) return;
    worst = sum(i);
    error.rms_component = layout.ComponentName(c);
  });
  error.rms = std::sqrt(worst / static_cast<double>(states.size()));
  return error;
}

std::optional<LinearisationError> LinearisationErrorOf(
    const Solution& solution, const Relinearised& anew) {
  const bool causal = solution.forward;
  if (causal && anew.smoother.rms < kDoubtfulError) return std::nullopt;
  LinearisationError error = anew.states.empty()
                                 ? anew.smoother
                                 : Compare(solution.layout, solution.states,
                                           solution.covariances, anew);
  error.causal = causal;
  error.settled = anew.smoother.settled;
  return error;
}

}  // namespace hindsight
