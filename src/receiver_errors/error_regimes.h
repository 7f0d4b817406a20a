#ifndef HINDSIGHT_RECEIVER_ERRORS_ERROR_REGIMES_H_
#define HINDSIGHT_RECEIVER_ERRORS_ERROR_REGIMES_H_

#include <functional>
#include <vector>

#include "receiver_errors/history_search.h"

namespace hindsight {

/// What the errors of a receiver are like, as found in its own data. Fixes are
/// white, with outliers; beyond that
///   white         nothing
///   gauss_markov  all fixes share a Gauss-Markov error
///   switching     the receiver is good, biased (by a Gauss-Markov error) or
///                 drifting, as the history says
///                 (receiver_errors/error_history.h)
struct ErrorRegimes {
  enum class Kind { kWhite, kGaussMarkov, kSwitching };
  Kind kind = Kind::kWhite;
  /// The likeliest history first; with kSwitching, others that the data do not
  /// rule out, each with the parameters of the fit that likes it best.
  std::vector<ScoredHistory> histories;
  /// ln of likelihood and prior of the first history, less (parameters / 2)
  /// ln(fixes): Schwarz's criterion.
  double criterion = 0.0;
};

/// "white", "gauss_markov", "switching".
const char* RegimeName(ErrorRegimes::Kind kind);

/// The data about a fixed nominal trajectory.
struct RegimeProblem {
  const LinearTape& tape;
  int receiver = 0;           ///< index of the position sensor
  double stated_sigma = 1.0;  ///< of its fixes, an axis [m]
  /// The layout has a Gauss-Markov error of the receiver already: only outliers
  /// are looked for.
  bool only_white = false;
  /// Called between the steps of the search; may throw to end it.
  std::function<void()> poll;
};

/// Fits every kind to the data and takes the one of the largest criterion; no
/// truth takes part. Parameters - scale, share and size of outliers, sigma and
/// tau of the Gauss-Markov error, sigma of the rate of drifts - maximise the
/// likelihood of the fixes, a mixture of two normal densities each (as in
/// Pfeifer and Protzel, ICRA 2019), under weak priors that keep what the data
/// do not show near its start. Histories are sought from several sizes of
/// errors, in turn with fits of the parameters to what was found; the best that
/// tell different stories are refined, each with parameters of its own.
ErrorRegimes ChooseRegimes(const RegimeProblem& problem);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_ERROR_REGIMES_H_
