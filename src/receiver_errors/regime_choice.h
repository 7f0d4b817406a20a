#ifndef HINDSIGHT_RECEIVER_ERRORS_REGIME_CHOICE_H_
#define HINDSIGHT_RECEIVER_ERRORS_REGIME_CHOICE_H_

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "receiver_errors/error_regimes.h"

namespace hindsight {

/// ln of the evidence by which a richer model of a sensor's errors has to win:
/// odds of a thousand, as it brings what a wrong one may ruin.
inline constexpr double kLeastGain = 6.907755278982137;
/// ln of odds of 10^(1/2), to which they are hardly worth mentioning (Jeffreys, Theory of
/// Probability, 1961).
inline constexpr double kHardlyWorthMentioning = 1.151292546497023;
/// As kLeastGain of switching errors of a sensor whose clock is known, beside which the
/// noise goes on as an alternative.
inline constexpr double kLeastGainOfSwitching = kHardlyWorthMentioning;

/// ln of the odds a priori that a sensor has a Gauss-Markov error from the first fix to the
/// last: of the ten recordings with a receiver in data/README.md two are found to have one
/// of positions (Laplace's rule of succession: one in four).
inline constexpr double kLogOddsOfSlowErrors = -1.0986122886681098;

/// A Gauss-Markov error of the size of what is stated (SlightBias) beside noise that was
/// chosen.
struct OpenBias {
  double Probability() const { return 1.0 / (1.0 + std::exp(-log_odds)); }

  ErrorParameters expected;  ///< as of SlightBias
  double log_odds = 0.0;     ///< against noise alone
};

/// That of a Gauss-Markov error whose evidence is so much more than that of noise, unless
/// noise rules it out to kLeastGain.
std::optional<OpenBias> LeftOpen(const SlightBias& slight, double log_gain);

/// Which of FitRegimes stands.
struct RegimeChoice {
  std::size_t chosen = 0;  ///< 0: the noise as stated, nothing else
  double gain = 0.0;       ///< ln of its evidence over that of the stated
  /// What became of the likeliest of the others, a clause each, if it did not
  /// stand: "switching errors, ... predict held-out ... worse".
  std::vector<std::string> refused;
  struct Undecided {
    std::size_t index = 0;
    double gain = 0.0;  ///< ln of its evidence over that of noise
  };
  /// The likeliest noise, whether it stands or not.
  std::size_t noise = 0;
  /// Where noise was chosen: of each richer kind the likeliest that noise does not rule
  /// out to kLeastGain, nor it the likeliest noise, unless it predicts held-out stretches
  /// worse. A Gauss-Markov error is weighed against white noise, of which it has all
  /// parameters; the others against the likeliest noise, and by held-out stretches against
  /// what was chosen. The likelier kind first.
  std::vector<Undecided> undecided;
  /// Where noise was chosen, weighed as undecided ones. Whatever else speaks against it,
  /// also where it is far likelier than noise: it moves nothing, but covariances are widened
  /// by it.
  std::optional<OpenBias> open;
};

/// Name of a parameter at a bound of its search; "" if there is none. As of
/// BoundedParameters.
std::string AtBound(const Hypothesis& best, bool any_least_scale);

/// The one of the largest evidence that stands: it
///   - wins by kLeastGain, or kLeastGainOfSwitching, over every simpler one;
///   - has no parameter at a bound of its search;
///   - if it is white, is what the batch can be solved with (CanBeSolved): with
///     an IMU worse than stated by more than kMisstatedImu it is no matter of
///     this sensor, and with better fixes nothing that is made use of;
///   - if it is Gauss-Markov, has fixes or the IMU at half of what is stated at least: a
///     stated sigma has slow errors in it, and where both are better nothing tells whose
///     what is slow is;
///   - does not lose to the stated noise, nor, if it is not white, to white
///     errors on held-out stretches (CompareHeldOut, at any length).
RegimeChoice ChooseRegime(const RegimeProblem& problem,
                          const std::vector<ErrorRegimes>& all);

/// The regimes at `chosen`, and beside switching ones the hypotheses of the
/// other switching and the white ones, which go on as alternatives at their own
/// evidence.
ErrorRegimes WithAlternatives(std::vector<ErrorRegimes> all,
                              std::size_t chosen);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_REGIME_CHOICE_H_
