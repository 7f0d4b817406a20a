#include "problems/single_pass.h"

#include <algorithm>
#include <utility>

#include "alignment/coarse_alignment.h"
#include "base/error.h"
#include "filters/transport.h"

namespace hindsight {
namespace {

std::vector<State> FirstOf(const std::vector<State>& states, double duration) {
  const double t_end = states.front().t + duration;
  const auto end =
      std::partition_point(states.begin(), states.end(),
                           [t_end](const State& x) { return x.t <= t_end; });
  return {states.begin(), end};
}

}  // namespace

std::vector<State> NominalOf(const LinearTape& tape) {
  std::vector<State> nominal;
  nominal.reserve(tape.size());
  for (std::size_t k = 0; k < tape.size(); ++k) {
    nominal.push_back(tape.epoch(k).x_plus);
  }
  return nominal;
}

void MoveToSmoothed(const ErrorLayout& layout,
                    const std::vector<State>& nominal,
                    SmoothedTrajectory* trajectory) {
  CovarianceSeries& P = trajectory->P;
  for (std::size_t k = 0; k < P.size(); ++k) {
    ErrorMatrix P_k = P.Get(k);
    MoveCovariance(Transport(layout, nominal[k], trajectory->states[k]), &P_k);
    P.Set(k, P_k);
  }
}

SmoothedTrajectory SmoothOnce(LinearTape tape) {
  return SmoothRts(
      std::move(tape),
      {.errors = false, .covariances = RtsOptions::Tangent::kSmoothed});
}

Realigned Realign(const ErrorLayout& layout, const Relinearised& anew,
                  const FilterAbout& filter) {
  if (!anew.smoother.settled || anew.smoother.largest < kDoubtfulError) {
    return {};
  }
  Realigned realigned;
  realigned.start = FirstOf(anew.states, kAlignmentWindow);
  try {
    realigned.trajectory = SmoothOnce(filter(realigned.start));
  } catch (const EstimationError&) {
    return {};
  }
  const SmoothedTrajectory& one = realigned.trajectory;
  const bool cured =
      Compare(layout, one.states, one.P, anew).largest < kDoubtfulError;
  return cured ? std::move(realigned) : Realigned();
}

}  // namespace hindsight
