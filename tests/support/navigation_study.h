#ifndef HINDSIGHT_TESTS_SUPPORT_NAVIGATION_STUDY_H_
#define HINDSIGHT_TESTS_SUPPORT_NAVIGATION_STUDY_H_

#include "problems/navigation_trial.h"
#include "simulation/scenario.h"

namespace hindsight::testing {

/// Seeds of one recording, which must outlive the study.
inline Study NavigationStudy(const PerfectRecording& recording,
                             const NavigationTrial& trial) {
  const hindsight::Recording realize = [&recording](std::uint64_t seed) {
    return recording.Realize(seed);
  };
  return {
      .tables = NavigationTables(trial.leg_ends),
      .cases = {{{}, [realize] { return realize; }, NavigationTrialOf(trial)}}};
}

}  // namespace hindsight::testing

#endif  // HINDSIGHT_TESTS_SUPPORT_NAVIGATION_STUDY_H_
