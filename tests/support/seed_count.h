#ifndef HINDSIGHT_TESTS_SUPPORT_SEED_COUNT_H_
#define HINDSIGHT_TESTS_SUPPORT_SEED_COUNT_H_

#include <algorithm>
#include <cstdlib>

namespace hindsight::testing {

/// Whether a sanitizer makes everything ten times slower and larger.
#ifdef HINDSIGHT_FEW_SEEDS
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/// Runs of a statistical test: `usual`, but a tenth of them (at least 2) under
/// a sanitizer and for coverage. Bounds are computed from what this returns.
constexpr int SeedCount(int usual) {
  return kSanitized ? std::min(usual, std::max(2, usual / 10)) : usual;
}

/// The same, but `all` of them if the environment sets HINDSIGHT_ALL_SEEDS.
inline int SeedCount(int usual, int all) {
  return std::getenv("HINDSIGHT_ALL_SEEDS") != nullptr ? all : SeedCount(usual);
}

}  // namespace hindsight::testing

#endif  // HINDSIGHT_TESTS_SUPPORT_SEED_COUNT_H_
