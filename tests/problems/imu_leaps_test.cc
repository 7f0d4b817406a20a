#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "io/config/scenario_config.h"
#include "problems/reconstruction.h"
#include "simulation/fault.h"
#include "simulation/scenario.h"

namespace hindsight {
namespace {

using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class ImuLeap : public ::testing::TestWithParam<const char*> {
 protected:
  static constexpr double kSize = 0.45;  // [s]

  static Solution Run(const char* fault, std::uint64_t seed) {
    Dataset dataset = Simulate(FindScenario(GetParam(), {}), seed);
    if (fault != nullptr) {
      ApplyFault({FindFaultKind(fault), "", kSize}, seed, &dataset);
    }
    return Reconstruction(dataset, {}).Run("batch");
  }
};

/// Under water the others hardly tell the two apart: then it is doubtful.
TEST_P(ImuLeap, IsToldWithItsSize) {
  const Solution run = Run("imu_leap", 21);
  const bool told = GetParam() != std::string("test_dive");
  EXPECT_EQ(GradeOf(run.evidence), told ? Grade::kUnusable : Grade::kDoubtful);
  ASSERT_EQ(run.rivals.size(), 1u);
  EXPECT_THAT(run.rivals.front().description,
              HasSubstr("the IMU's clock leaps by 0.45 s"));
  EXPECT_NEAR(run.rivals.front().differences.front().value, kSize, 1e-9);
  EXPECT_GE(run.rivals.front().probability, told ? 0.999 : 0.02);
  EXPECT_THAT(
      run.evidence,
      Contains(Field(&Evidence::remedies,
                     Contains(HasSubstr("0.45 s less in the stamps")))));
}

TEST_P(ImuLeap, OfSamplesThatWereLostIsNotTheLikelierOne) {
  const Solution run = Run("imu_gap", 21);
  EXPECT_NE(GradeOf(run.evidence), Grade::kUnusable);
  for (const RivalSolution& rival : run.rivals) {
    EXPECT_LT(rival.probability, 0.1) << rival.description;
  }
}

TEST_P(ImuLeap, IsNotSoughtWhereNothingIsMissing) {
  EXPECT_THAT(Run(nullptr, 21).rivals, IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Vehicles, ImuLeap,
                         ::testing::Values("test_car", "test_aircraft",
                                           "test_dive", "test_hand"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace hindsight
