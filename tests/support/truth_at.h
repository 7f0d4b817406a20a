#ifndef HINDSIGHT_TESTS_SUPPORT_TRUTH_AT_H_
#define HINDSIGHT_TESTS_SUPPORT_TRUTH_AT_H_

#include "dataset/dataset.h"

namespace hindsight::testing {

/// The first truth point at t or after it; there must be one.
inline TruthPoint TruthAt(const Dataset& dataset, double t) {
  std::size_t k = 0;
  while (dataset.truth[k].t < t - 1e-6) ++k;
  return dataset.truth[k];
}

}  // namespace hindsight::testing

#endif  // HINDSIGHT_TESTS_SUPPORT_TRUTH_AT_H_
