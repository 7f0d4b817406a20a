#ifndef HINDSIGHT_PROBLEMS_ROBUST_SEARCH_H_
#define HINDSIGHT_PROBLEMS_ROBUST_SEARCH_H_

#include <chrono>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "problems/method_stage.h"
#include "problems/robust_batch.h"

namespace hindsight {

/// Clocks so far from where nodes stand are others [sigma].
inline constexpr double kElsewhere = 5.0;

/// What was decided, where the nodes stood, and what came of it last.
struct RobustSearch {
  explicit RobustSearch(std::chrono::steady_clock::time_point until)
      : end(until) {}

  /// Asked of what is to be searched for: then it is not.
  bool IsOutOfTime() {
    const bool over = std::chrono::steady_clock::now() >= end;
    ended |= over;
    return over;
  }

  std::chrono::steady_clock::time_point end;
  /// Errors are sought about the trajectory that the nodes have, in place of a rough
  /// one: it was found without what errs.
  bool begins_at_nodes = false;
  bool done = false;
  /// So often nodes were placed where the rough trajectory has the clocks.
  int placed = 0;
  SearchDecisions decisions;
  std::vector<int> last;      ///< as of RobustBatchOptions
  std::vector<int> left_out;  ///< as of RobustBatchResult
  bool left_out_unasked = false;
  std::vector<double> offsets;  ///< by sensor [s]
  bool stands = false;
  bool ended = false;  ///< something was not searched for, as the time was over
  std::vector<std::string> notes;
  std::optional<Evidence> other_order;
  ErrorLayout layout;
  State x;        ///< the solution's at its last node
  ErrorMatrix P;  ///< of it
  /// Where clocks are in question: what is taken for outliers or biased, and the
  /// problem with the errors that were found.
  std::set<MeasurementKey> erring;
  std::optional<Problem> problem;
  double log_prior = 0.0;  ///< as of RobustBatchResult
};

/// The batch with the errors that are found, on nodes that stand where its clocks say
/// (MethodStage::AtOwnNodes), beginning where a rough trajectory has them; the plain
/// batch if none are. What is decided about nodes that moved by less than a sigma holds.
Solution SearchAtOwnNodes(MethodStage* stage, RobustSearch* searched);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_ROBUST_SEARCH_H_
