#ifndef HINDSIGHT_PROBLEMS_ROUGH_TRAJECTORY_H_
#define HINDSIGHT_PROBLEMS_ROUGH_TRAJECTORY_H_

#include <vector>

#include "problems/method_stage.h"

namespace hindsight {

/// A trajectory about which errors of sensors are sought.
struct RoughTrajectory {
  std::vector<State> states;  ///< a node
  CovarianceSeries P = {};    ///< over the layout of the problem
  /// Sensors of headings and magnetic fields, where they contradict all others.
  std::vector<int> contradicted = {};
};

/// That of the IMM smoother: the EKF's may be so far off after an outlier that a
/// linearisation about it is of no use. So may be one that follows headings which err:
/// where those contradict what moves, by a mean square of the angle above 25 of the
/// latter's variances, it is the one without them. `problem` is that of the nodes with
/// what is to be used, among which are blunders it leaves out if `has_blunders`.
RoughTrajectory RoughlySolved(const MethodStage& stage,
                              const MethodStage::Nodes& nodes,
                              const Problem& problem, bool has_blunders);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_ROUGH_TRAJECTORY_H_
