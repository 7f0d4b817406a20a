#include "problems/open_biases.h"

#include <cstddef>
#include <map>
#include <memory>
#include <utility>

#include "filters/forward_filter.h"
#include "filters/linear_tape.h"
#include "filters/rts.h"

namespace hindsight {
namespace {

/// What was decided last of each sensor.
std::map<std::size_t, std::shared_ptr<const ErrorDecisions>> LastOf(
    const SearchDecisions& decisions) {
  std::map<std::size_t, std::shared_ptr<const ErrorDecisions>> last;
  for (const DecidedRound& round : decisions) {
    for (const auto& one : round.errors) last[SensorOf(*one)] = one;
  }
  return last;
}

/// With zeros for what the layout has beyond them.
std::vector<State> Over(const ErrorLayout& layout, std::vector<State> states) {
  for (State& x : states) {
    const Eigen::Index count = x.parameters.size();
    x.parameters.conservativeResize(layout.parameter_count());
    x.parameters.tail(layout.parameter_count() - count).setZero();
  }
  return states;
}

}  // namespace

std::vector<std::string> WidenByOpenBiases(const SearchDecisions& decisions,
                                           const Problem& problem,
                                           const std::vector<State>& states,
                                           CovarianceSeries* P) {
  constexpr int kErrorStates = 3;
  std::vector<std::string> held;
  if (!HasRoomFor(problem.layout, kErrorStates)) return held;
  const int dim = problem.layout.dim();
  std::unique_ptr<const LinearTape> tape;
  SmoothedTrajectory without;
  for (const auto& [sensor, one] : LastOf(decisions)) {
    if (!HasOpenBias(*one)) continue;
    if (tape == nullptr) {
      Problem as_solved = problem;
      tape = std::make_unique<const LinearTape>(
          RunLinearizedFilter(states, &as_solved));
      without = SmoothRts(*tape);
    }
    Problem extended = problem;
    const double probability = ExtendByOpenBias(*one, *tape, &extended);
    if (probability == 0.0) continue;
    const SmoothedTrajectory with = SmoothRts(
        RunLinearizedFilter(Over(extended.layout, states), &extended));
    for (std::size_t k = 0; k < states.size(); ++k) {
      const ErrorVector d = with.d[k].head(dim) - without.d[k];
      ErrorMatrix P_k = P->Get(k);
      P_k += probability * (with.P.Get(k).topLeftCorner(dim, dim) -
                            without.P.Get(k) + d * d.transpose());
      P->Set(k, P_k);
    }
    held.push_back(OpenBiasInWords(*one));
  }
  return held;
}

}  // namespace hindsight
