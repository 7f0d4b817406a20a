#ifndef HINDSIGHT_TIMELINE_PROBLEM_H_
#define HINDSIGHT_TIMELINE_PROBLEM_H_

#include <vector>

#include "timeline/timeline.h"

namespace hindsight {

/// Where an estimation starts: a state and the covariance of its error.
struct Prior {
  State x;
  ErrorMatrix P;
};

/// Which measurements are used. Empty: the gate of each sensor decides by the
/// innovation, as far as the estimator has one. Otherwise one flag a
/// measurement of the timeline, in order.
using GateDecisions = std::vector<char>;

/// An estimation problem, whatever solves it: what is estimated over which
/// layout, from which prior at the first node, along which nodes with their
/// measurements, and which of these count. A value: a copy shares the IMU
/// summaries until one of the two integrates anew.
struct Problem {
  ErrorLayout layout;
  Prior prior;
  Timeline timeline;
  GateDecisions decisions = {};
};

}  // namespace hindsight

#endif  // HINDSIGHT_TIMELINE_PROBLEM_H_
