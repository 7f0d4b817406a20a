#ifndef HINDSIGHT_PROBLEMS_SINGLE_PASS_H_
#define HINDSIGHT_PROBLEMS_SINGLE_PASS_H_

#include <functional>
#include <span>
#include <vector>

#include "filters/rts.h"
#include "problems/linearisation.h"

namespace hindsight {

/// \file
/// Smoothers that linearise once, about what a forward filter went along.

/// The nominal of a tape, x_plus of every epoch.
std::vector<State> NominalOf(const LinearTape& tape);

/// Moves the covariances of a trajectory smoothed on a tape, which are in the
/// tangent of the tape's nominal, into that at the smoothed states.
void MoveToSmoothed(const ErrorLayout& layout,
                    const std::vector<State>& nominal,
                    SmoothedTrajectory* trajectory);

/// RTS over a tape, covariances in the tangent at the smoothed states, without
/// errors.
SmoothedTrajectory SmoothOnce(LinearTape tape);

/// A trajectory of one pass, of which the first nodes are linearised elsewhere
/// than where the filter was.
struct Realigned {
  std::vector<State> start;  ///< about these; empty: the filter's are as good
  SmoothedTrajectory trajectory;
};

/// A filter, its first nodes linearised about those given (ForwardModel).
using FilterAbout = std::function<LinearTape(std::span<const State> start)>;

/// While its attitude is poorly known a filter is linearised off, and so is its
/// smoother, which knows better. If that makes a smoother doubtful which is not
/// so with kAlignmentWindow from the first node on linearised about the
/// interval's trajectory, gives that one; else nothing.
Realigned Realign(const ErrorLayout& layout, const Relinearised& anew,
                  const FilterAbout& filter);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_SINGLE_PASS_H_
