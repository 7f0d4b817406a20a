#ifndef HINDSIGHT_TESTS_STATE_RANDOM_ERROR_H_
#define HINDSIGHT_TESTS_STATE_RANDOM_ERROR_H_

#include "base/random.h"
#include "state/error_layout.h"

namespace hindsight::testing {

/// Every component normal with standard deviation `size`, in its own unit.
inline ErrorVector RandomError(const ErrorLayout& layout, Random* random,
                               double size) {
  ErrorVector d(layout.dim());
  for (double& value : d) value = size * random->Normal();
  return d;
}

}  // namespace hindsight::testing

#endif  // HINDSIGHT_TESTS_STATE_RANDOM_ERROR_H_
