#ifndef HINDSIGHT_PROBLEMS_NODE_PLACEMENT_H_
#define HINDSIGHT_PROBLEMS_NODE_PLACEMENT_H_

#include <vector>

#include "dataset/timeline_builder.h"
#include "state/solution.h"
#include "timeline/problem.h"

namespace hindsight {

/// The nodes of an interval where given time offsets place them, with what a
/// method needs to go on from a solution on other nodes.
struct PlacedNodes {
  std::vector<double> offsets;  ///< by sensor: stamp + offset is a node [s]
  Problem problem;              ///< its offsets linearised along `states`
  std::vector<State> states;    ///< the solution, a state a node
};

/// So often nodes are placed anew before a time offset is said not to settle.
inline constexpr int kMaxPlacements = 12;

/// A time offset nearer to its nodes than this is settled [standard deviations].
inline constexpr double kSettledOffset = 0.1;

bool EstimatesTimeOffsets(const ErrorLayout& layout);

/// The sensor whose time offset, estimated by a state and its covariance, is
/// farthest from where its nodes stand: by `least` of its standard deviations or
/// more, else -1.
int FarthestFromNodes(const ErrorLayout& layout,
                      const std::vector<double>& offsets, const State& x,
                      const ErrorMatrix& P, double least = kSettledOffset);

/// Where the nodes of estimated time offsets go next: to the estimates; where
/// the last two steps of an offset point at each other, to the root of the line
/// through them, so that it does not go to and fro.
class OffsetSearch {
 public:
  /// `placed` are the offsets of the nodes on which state x was estimated over
  /// `layout`. Throws EstimationError, by the sensor's name, if an offset is no
  /// number.
  std::vector<double> Next(const ErrorLayout& layout,
                           const std::vector<Sensor>& sensors, const State& x,
                           const std::vector<double>& placed);

 private:
  std::vector<double> placed_;  // of the call before
  std::vector<double> steps_;
};

/// Places nodes by `options` at a solution of `problem`: `states` over `layout`,
/// whose first blocks are those of the problem.
PlacedNodes PlaceNodesAnew(const Dataset& dataset,
                           const TimelineOptions& options,
                           const Problem& problem, const ErrorLayout& layout,
                           const std::vector<State>& states);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_NODE_PLACEMENT_H_
