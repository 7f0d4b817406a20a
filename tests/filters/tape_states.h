#ifndef HINDSIGHT_TESTS_FILTERS_TAPE_STATES_H_
#define HINDSIGHT_TESTS_FILTERS_TAPE_STATES_H_

#include <vector>

#include "filters/linear_tape.h"

namespace hindsight::testing {

inline std::vector<State> StatesAfter(const LinearTape& tape) {
  std::vector<State> states;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    states.push_back(tape.epoch(k).x_plus);
  }
  return states;
}

}  // namespace hindsight::testing

#endif  // HINDSIGHT_TESTS_FILTERS_TAPE_STATES_H_
