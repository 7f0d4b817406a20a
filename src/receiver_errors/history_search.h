#ifndef HINDSIGHT_RECEIVER_ERRORS_HISTORY_SEARCH_H_
#define HINDSIGHT_RECEIVER_ERRORS_HISTORY_SEARCH_H_

#include "receiver_errors/error_history.h"

namespace hindsight {

struct ScoredHistory {
  ErrorHistory history;
  double log_posterior = 0.0;  ///< but for a constant of the data
  /// How many histories of about the same likelihood, with times next to these,
  /// this one stands for.
  double count = 1.0;
  ErrorParameters parameters = {};  ///< that it was scored with
};

/// The likeliest histories of a receiver's error, best first: a Kalman filter
/// each, split at every fix into all steps that may follow and pruned again
/// (Singer, Sea and Housewright, IEEE Trans. Inf. Theory 20(4), 1974; merging
/// of near ones as in Salmond, SPIE 1305, 1990). Unlike an IMM, which mixes
/// what its modes know at every fix, a history remembers when its error began,
/// so that one that begins too slowly for any single fix to show is found once
/// the fixes together do.
/// At most `width` histories of each mode, and of each power of two of fixes
/// since what goes on began, stay after a fix.
std::vector<ScoredHistory> SearchHistories(const LinearTape& tape, int receiver,
                                           const ErrorParameters& parameters,
                                           std::size_t width = 3);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_HISTORY_SEARCH_H_
