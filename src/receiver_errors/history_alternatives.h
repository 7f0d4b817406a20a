#ifndef HINDSIGHT_RECEIVER_ERRORS_HISTORY_ALTERNATIVES_H_
#define HINDSIGHT_RECEIVER_ERRORS_HISTORY_ALTERNATIVES_H_

#include <vector>

#include "receiver_errors/error_regimes.h"

namespace hindsight {

/// A history that the data do not rule out.
struct HistoryAlternative {
  double weight = 0.0;                ///< its probability among them
  ErrorParameters parameters;         ///< as fitted to its kind
  std::vector<ErrorStep> steps;       ///< by node
  std::vector<ErrorVector> smoothed;  ///< SmoothHistory of it
};

/// The likeliest histories of the regimes, at most 24 of them and at most 8 of
/// each story (StoryOf). The 8 share the weight of all histories that tell
/// their story, so that a story with many possible times does not drive out
/// another.
std::vector<HistoryAlternative> WeighHistories(const LinearTape& tape,
                                               int receiver,
                                               const ErrorRegimes& regimes);

/// The one whose horizontal positions are nearest to all, in the mean square
/// weighed by their probabilities.
const HistoryAlternative& MostCentral(
    const std::vector<HistoryAlternative>& all);

/// sum_h w_h d_h d_h' over the first `dim` errors at node k, d_h the distance
/// of the smoothed error of h from that of `center`.
ErrorMatrix Spread(const std::vector<HistoryAlternative>& all,
                   const HistoryAlternative& center, std::size_t k, int dim);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_HISTORY_ALTERNATIVES_H_
