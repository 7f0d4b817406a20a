#ifndef HINDSIGHT_APP_OBSERVER_FLAGS_H_
#define HINDSIGHT_APP_OBSERVER_FLAGS_H_

#include <string>
#include <vector>

#include "app/command.h"
#include "problems/papers/observer_comparison.h"

namespace hindsight {

/// A command's flags followed by those of forward observers: error, gamma,
/// alpha, alpha_blocks, delta, bounded, back_off.
std::vector<FlagUse> WithObserverFlags(std::vector<FlagUse> flags);

/// What the flags ask for. All throw UsageError naming the flag.
std::vector<ErrorDefinition> ReadErrors();
std::vector<double> ReadGammas();
/// The rule with the parameters of the flags, gamma being the first of its
/// list.
CovarianceOptions ReadCovariance(RiccatiRule rule);

/// Of --methods, all three without it, with every one of their parameters and
/// definition of --error. Throws UsageError.
std::vector<ObserverModel> ReadObserverModels();

/// Throws UsageError if a parameter is given of a rule that does not run.
void CheckObserverFlags(bool hinf, bool modified);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_OBSERVER_FLAGS_H_
