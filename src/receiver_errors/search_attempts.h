#ifndef HINDSIGHT_RECEIVER_ERRORS_SEARCH_ATTEMPTS_H_
#define HINDSIGHT_RECEIVER_ERRORS_SEARCH_ATTEMPTS_H_

#include <vector>

#include "receiver_errors/error_regimes.h"

namespace hindsight {

/// A sequence that may be near the likeliest, with parameters fitted to it.
struct Attempt {
  ErrorParameters parameters;
  ModeSequence sequence;
  double log_posterior = 0.0;
};

/// Narrow searches in turn with fits of the parameters, best first. Until the
/// parameters have been fitted to a sequence, its posterior says little: to a
/// fit of white errors biases look like noise and outliers, and of a start the
/// sizes are wrong.
/// `white` is what a fit of white errors gave.
std::vector<Attempt> MakeAttempts(const RegimeProblem& problem,
                                  const ErrorParameters& white);

/// Attempts that a climb may yet make the likelier ones. At least two more
/// parameters cost ln(fixes), and what does not win by kLeastGain does not stand;
/// climbs gain some ten from where narrow searches end.
std::vector<Attempt> Hopeful(std::vector<Attempt> attempts,
                             double log_posterior_of_white);

/// The best attempts whose trajectories differ: each goes on with the parameters
/// that suit it.
/// `attempts` are in the order of MakeAttempts.
std::vector<Attempt> BestAttempts(const RegimeProblem& problem,
                                  const std::vector<Attempt>& attempts);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_SEARCH_ATTEMPTS_H_
