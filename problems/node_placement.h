#ifndef HINDSIGHT_PROBLEMS_NODE_PLACEMENT_H_
#define HINDSIGHT_PROBLEMS_NODE_PLACEMENT_H_

#include <vector>

#include "dataset/timeline_builder.h"
#include "filters/measurement_rule.h"
#include "state/solution.h"

namespace hindsight {

/// The nodes of an interval where given time offsets place them, with what a
/// method needs to go on from a solution on other nodes.
struct PlacedNodes {
  std::vector<double> offsets;  ///< by sensor: stamp + offset is a node [s]
  Timeline timeline;            ///< its offsets linearised along `states`
  std::vector<State> states;    ///< the solution, a state a node
  GateDecisions decisions;
};

/// So often nodes are placed anew before a time offset is said not to settle.
inline constexpr int kMaxPlacements = 12;

bool EstimatesTimeOffsets(const ErrorLayout& layout);

/// The sensor whose time offset, estimated by a state and its covariance, is
/// farthest from where its nodes stand: by a tenth of its standard deviation or
/// more, else -1.
int FarthestFromNodes(const ErrorLayout& layout,
                      const std::vector<double>& offsets, const State& x,
                      const ErrorMatrix& P);

/// Places nodes by the time offsets that `states` estimate over `layout`, whose
/// first blocks are those of `base`; `options` says all else. `placed` are the
/// offsets of `timeline`, on which the states stand and the decisions were
/// taken. Throws EstimationError if an offset is no number.
PlacedNodes PlaceNodesAnew(const Dataset& dataset, TimelineOptions options,
                           const ErrorLayout& base, const ErrorLayout& layout,
                           const std::vector<State>& states,
                           const std::vector<double>& placed,
                           const Timeline& timeline,
                           const GateDecisions& decisions);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_NODE_PLACEMENT_H_
