#ifndef HINDSIGHT_EVALUATION_TRUE_STATES_H_
#define HINDSIGHT_EVALUATION_TRUE_STATES_H_

#include <vector>

#include "dataset/dataset.h"
#include "state/error_layout.h"
#include "state/state.h"

namespace hindsight {

/// True states at the times of `states`, in a layout's parameters too where
/// the data set knows them; elsewhere those of `states`. Throws InputError where there is no truth within
/// 1 us.
std::vector<State> TrueStates(const Dataset& dataset, const ErrorLayout& layout,
                              const std::vector<State>& states);

/// Components of the layout of which TrueStates has the truth: all but those of
/// parameters that the data set does not know, such as a sensor error that
/// wanders.
std::vector<int> ComponentsWithTruth(const Dataset& dataset,
                                     const ErrorLayout& layout);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_TRUE_STATES_H_
