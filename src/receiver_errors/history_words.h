#ifndef HINDSIGHT_RECEIVER_ERRORS_HISTORY_WORDS_H_
#define HINDSIGHT_RECEIVER_ERRORS_HISTORY_WORDS_H_

#include <string>
#include <vector>

#include "receiver_errors/history_alternatives.h"
#include "state/covariance_series.h"

namespace hindsight {

/// A history in words, "biased from 120 to 140 s, drifting from 175 s to the
/// end"; a bias or drift drawn anew begins a part of its own. `times` are those
/// of the nodes. "good throughout" if there is nothing to tell.
std::string DescribeHistory(const std::vector<ErrorStep>& steps,
                            const std::vector<double>& times);

/// The likeliest history that takes the trajectory elsewhere than `chosen`,
/// more than three standard deviations of P (errors of the chosen one's
/// horizontal position first) at some node.
struct RivalHistory {
  const HistoryAlternative* history = nullptr;  ///< none: no such history
  double probability = 0.0;                     ///< of all such together
  double distance = 0.0;  ///< largest, horizontal [m], of the likeliest
};
RivalHistory FindRival(const std::vector<HistoryAlternative>& all,
                       const HistoryAlternative& chosen,
                       const CovarianceSeries& P);

/// What the noise and the errors of a receiver are like, a sentence each.
std::vector<std::string> DescribeParameters(ErrorRegimes::Kind kind,
                                            const HistoryAlternative& chosen);
/// What else may have happened; empty where it is too improbable to be told.
std::string DescribeRival(const RivalHistory& rival,
                          const std::vector<double>& times);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_HISTORY_WORDS_H_
