#ifndef HINDSIGHT_PROBLEMS_EXPLAINED_ERRORS_H_
#define HINDSIGHT_PROBLEMS_EXPLAINED_ERRORS_H_

#include <optional>
#include <string>
#include <vector>

#include "problems/error_search.h"

namespace hindsight {

/// What else explains the data, in another order of the sensors.
struct RivalSearch {
  std::vector<State> states;
  std::string words;
  double log_odds = 0.0;  ///< against it
};

/// Errors of sensors that explain the data.
struct ExplainedErrors {
  ErrorSearch search;
  std::optional<RivalSearch> rival;
  /// Where RobustBatchOptions::last names sensors: what explains the others without
  /// them.
  std::optional<ErrorSearch> without_last;
};

/// The likeliest explanation of the orders in which errors of sensors are sought: each
/// with the others taken at their word, velocities before positions, wheels before all
/// else; or as RobustBatchOptions::decisions say. About `initial`, a state a node.
/// `share`: of the effort of a search. `options` must outlive what is returned.
ExplainedErrors ExplainErrors(const Problem& problem,
                              const std::vector<State>& initial,
                              const RobustBatchOptions& options, double share);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_EXPLAINED_ERRORS_H_
