#ifndef HINDSIGHT_PROBLEMS_ROBUST_BATCH_H_
#define HINDSIGHT_PROBLEMS_ROBUST_BATCH_H_

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "problems/batch.h"
#include "receiver_errors/receiver_errors.h"
#include "state/solution.h"

namespace hindsight {

/// Odds of a thousand, from which on an explanation stands alone [ln].
inline constexpr double kSureLogOdds = 6.907755278982137;

struct DecidedRound {
  DecidedErrors errors = {};
  /// Sensors whose measurements were left out while these were sought.
  std::vector<int> without = {};
};

/// What a search decided, by round.
using SearchDecisions = std::vector<DecidedRound>;

struct RobustBatchResult {
  /// As it was solved: with the errors of sensors that were found, and their
  /// rates, sigmas, losses and error steps.
  Problem problem;
  BatchResult batch = {};  ///< P widened by the other hypotheses
  ModePart modes = {};  ///< of the sensor whose errors have the most evidence
  /// By sensor and node, the probability that a measurement is taken at its word:
  /// not as biased. Empty of a sensor without errors.
  std::vector<std::vector<double>> trust = {};
  /// Whether any errors were found that stand against the noise as stated, or blunders
  /// or sensors were left out, and the batch with them converged. If not, only notes
  /// and doubts are filled in: the plain batch is the result.
  bool stands = false;
  std::vector<BoundedValue> bounded = {};
  std::vector<std::string> notes = {};  ///< what was found, in words
  std::vector<Evidence> doubts = {};    ///< what makes the result doubtful
  /// That sensors searched in another order explain the data too: of where nodes
  /// stood at the search. Not among `doubts`, as it is not known again where
  /// decisions are given.
  std::optional<Evidence> other_order = {};
  /// Sensors of RobustBatchOptions::last of which no measurement is used: with or
  /// without errors of theirs the batch contradicts all others, does not converge, or
  /// they were not searched.
  std::vector<int> left_out = {};
  /// These were not searched, as there was no time.
  bool left_out_unasked = false;
  /// Whether something was not searched for, or not to its end, as go_on said so. Not
  /// among `doubts`, as it is not known again where decisions are given.
  bool ended = false;
  SearchDecisions decisions = {};
  /// ln of the prior of the errors that were found.
  double log_prior = 0.0;
};

struct RobustBatchOptions {
  BatchOptions batch;
  /// What the gates of sensors without errors decided: used where others are
  /// found. Empty: as the problem says.
  GateDecisions gates = {};
  /// Measurements that `problem` leaves out whatever is found (FindBlunders).
  std::vector<std::size_t> blunders = {};
  /// Sensors that the others contradict about `initial`: they are left out until errors
  /// of the others have been sought, and are then the first to be asked.
  std::vector<int> last = {};
  /// Of a search about other nodes of the same recording: taken as they are, if
  /// the nodes hold the same fixes, instead of a search. nullptr: none.
  const SearchDecisions* decisions = nullptr;
  /// What an earlier search of the same recording decided: where nodes hold as many
  /// fixes, others begin from the sequences that it has met as well. nullptr: none.
  const SearchDecisions* met = nullptr;
  /// Of each epoch of each pass; may throw to stop.
  EpochCallback callback = nullptr;
  /// Told the fraction of the search that is done; false ends it with the best
  /// so far, and no other begins.
  std::function<bool(double)> go_on = nullptr;
  /// When it says so, as of ErrorQuestion.
  std::chrono::steady_clock::time_point until =
      std::chrono::steady_clock::time_point::max();
};

/// Takes no measurement of the sensors.
void LeaveOut(const std::vector<int>& sensors, const Timeline& timeline,
              GateDecisions* decisions);

/// Whole-interval least squares that finds out by itself what the errors of the
/// absolute sensors are like.
///
/// FindReceiverErrors looks for them about the trajectory `initial`, for each
/// sensor by itself, the others being taken at their word: which one errs is part
/// of the hypothesis. The one whose errors gain the most evidence is
/// given them, and the rest are searched again about the trajectory that follows,
/// until none gains any more. The batch then has
///   - those sensors' sigmas as found, with a two-component mixture as the loss;
///   - the error of each as states of every node, and if it drifts its rate as
///     well (state/block_step.h), which go from node to node as the chosen
///     hypothesis says.
/// Where velocities over the ground may err with the positions, they are searched
/// first, without the positions, as well; where heights, headings or fields err beside
/// doubtful positions, the positions are, without those. The order with more evidence
/// counts. Where the solution's attitude is beyond what is linear about `initial`,
/// errors are sought again about it, at most twice; what is found counts if its evidence
/// is larger. Headings that all others contradict still, whatever errors they are given,
/// are left out.
/// It starts from that hypothesis's trajectory; the distances of the others widen
/// the covariances. Where errors of another sensor explain the data as well, to
/// odds of a thousand, and lead elsewhere, the result is doubtful, says both, and
/// its covariances are widened by their distance.
RobustBatchResult SolveRobustBatch(Problem problem,
                                   const std::vector<State>& initial,
                                   const RobustBatchOptions& options);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_ROBUST_BATCH_H_
