#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/config/scenario_config.h"
#include "problems/reconstruction.h"
#include "simulation/fault.h"
#include "simulation/scenario.h"
#include "support/seed_count.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;

struct FaultyCase {
  const char* vehicle;
  const char* fault;
  const char* sensor;
  double size;  ///< SI
  const char* says;
};

std::vector<std::string> WhatSpeaksAgainst(const Dataset& dataset) {
  Reconstruction reconstruction(dataset, {});
  std::vector<std::string> all;
  for (const Evidence& evidence : reconstruction.Run("batch").evidence) {
    if (evidence.grade != Grade::kUsable) all.push_back(evidence.what);
  }
  return all;
}

class ExplanationOfFault : public ::testing::TestWithParam<FaultyCase> {};

TEST_P(ExplanationOfFault, NamesIt) {
  const FaultyCase& c = GetParam();
  Dataset dataset = Simulate(FindScenario(c.vehicle, {}), 11);
  ApplyFault({FindFaultKind(c.fault), c.sensor, c.size}, 11, &dataset);
  EXPECT_THAT(WhatSpeaksAgainst(dataset),
              ::testing::Contains(HasSubstr(c.says)));
}

INSTANTIATE_TEST_SUITE_P(
    Faults, ExplanationOfFault,
    ::testing::Values(
        FaultyCase{"test_car", "delay", "position", 0.2,
                   "gnss is stamped 0.21 s late"},
        FaultyCase{"test_car", "lever_arm", "position", 1.0,
                   "gnss stands -1 m more forward than its lever arm says"},
        FaultyCase{"test_car", "step", "position", 3.0, "gnss [north] is "},
        FaultyCase{"test_car", "lasting", "position", 1.5,
                   "last longer than the time between its measurements"},
        FaultyCase{"test_aircraft", "imu_rate", "", 2e-4,
                   "s/s faster than all others"},
        FaultyCase{"test_aircraft", "gyro_step", "", 3.5e-4,
                   "gyro_bias[z] jumps"},
        FaultyCase{"test_dive", "lasting", "dvl", 0.03, "of dvl"}));

TEST(Explanation, AHealthyRecordingNeedsNone) {
  const int seeds = testing::SeedCount(25, 100);
  int doubted = 0;
  for (const char* vehicle :
       {"test_car", "test_aircraft", "test_dive", "test_hand"}) {
    const PerfectRecording perfect(FindScenario(vehicle, {}));
    for (int seed = 0; seed < seeds; ++seed) {
      if (!WhatSpeaksAgainst(
               perfect.Realize(4000 + static_cast<unsigned>(seed)))
               .empty()) {
        ++doubted;
      }
    }
  }
  // Asked: 97 % usable.
  EXPECT_LE(doubted, 4 * seeds * 3 / 100);
}

}  // namespace
}  // namespace hindsight
