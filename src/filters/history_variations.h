#ifndef HINDSIGHT_FILTERS_HISTORY_VARIATIONS_H_
#define HINDSIGHT_FILTERS_HISTORY_VARIATIONS_H_

#include <vector>

#include "filters/history_search.h"

namespace hindsight {

/// Histories near another: a change moved by up to eight fixes, left out, of
/// another kind, or with a bias before it; all from a change on taken for jolts
/// of the IMU; the good and the erroneous stretch about a change taken for each
/// other.
std::vector<ErrorHistory> Variations(const ErrorHistory& history);
/// With a jolt of the IMU, at each fix that has none and where nothing changes.
std::vector<ErrorHistory> WithOneJolt(const ErrorHistory& history);

/// An error too small to be found alone may have begun at any time before a
/// change: each time is unlikely, all together may not be. And a jump may be
/// the end of a drift that began unseen. Lengths are a quarter apart, each
/// stands (`count`) for those up to the next; the rest is not filled.
std::vector<ScoredHistory> EarlierErrors(const ErrorHistory& history);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_HISTORY_VARIATIONS_H_
