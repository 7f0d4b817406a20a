#ifndef HINDSIGHT_RECEIVER_ERRORS_HISTORY_VARIATIONS_H_
#define HINDSIGHT_RECEIVER_ERRORS_HISTORY_VARIATIONS_H_

#include <vector>

#include "receiver_errors/history_search.h"

namespace hindsight {

/// Histories that differ from `history` at one change: it comes up to eight
/// fixes earlier or later, does not come, is of another kind, or follows a
/// bias; or it and all changes after it are jolts of the IMU; or the stretches
/// before and after it change roles, the good one being the erroneous one.
std::vector<ErrorHistory> Variations(const ErrorHistory& history);
/// Histories with one jolt of the IMU more than `history`: one for each fix at
/// which nothing changes and which has no jolt.
std::vector<ErrorHistory> WithOneJolt(const ErrorHistory& history);

/// An error too small to be found alone may have begun at any time before a
/// change: each time is unlikely, all together may not be. And a jump may be
/// the end of a drift that began unseen. Lengths are a quarter apart, each
/// stands (`count`) for those up to the next; the rest is not filled.
std::vector<ScoredHistory> EarlierErrors(const ErrorHistory& history);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_HISTORY_VARIATIONS_H_
