#ifndef HINDSIGHT_TESTS_SUPPORT_SEED_COUNT_H_
#define HINDSIGHT_TESTS_SUPPORT_SEED_COUNT_H_

#include <algorithm>

namespace hindsight::testing {

/// Runs of a statistical test: `all`, but a tenth of them (at least 2) where a
/// sanitizer makes each ten times slower. Bounds are computed from what this
/// returns.
constexpr int SeedCount(int all) {
#ifdef HINDSIGHT_FEW_SEEDS
  return std::max(2, all / 10);
#else
  return all;
#endif
}

}  // namespace hindsight::testing

#endif  // HINDSIGHT_TESTS_SUPPORT_SEED_COUNT_H_
