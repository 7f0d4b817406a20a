#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "evaluation/grade.h"
#include "io/config/scenario_config.h"
#include "problems/reconstruction.h"
#include "simulation/fault.h"
#include "simulation/scenario.h"

namespace hindsight {
namespace {

/// `ahrs` of a sensor in the hand with a fault of its magnetometer.
Solution Filtered(const char* fault, double size) {
  Dataset dataset = Simulate(FindScenario("test_worn", {}), 11);
  ApplyFault({FindFaultKind(fault), "magnetometer", size}, 11, &dataset);
  ReconstructionOptions options;
  options.attitude_alone = true;
  options.method = "ahrs";
  return Solve(dataset, options);
}

const Evidence* InnovationsOf(const Solution& solution) {
  const auto found =
      std::find_if(solution.evidence.begin(), solution.evidence.end(),
                   [](const Evidence& e) { return e.rule == "innovations"; });
  return found == solution.evidence.end() ? nullptr : &*found;
}

/// A filter that hears of a wrong field, says so in its sigma, and is where the
/// smoother is, which knows that field by then.
TEST(AttitudeJudgement, AFilterThatItsSmootherVouchesForIsDoubtful) {
  for (const auto& [fault, size] :
       {std::pair("unit", 0.1), std::pair("scale", 0.5)}) {
    const Solution solution = Filtered(fault, size);
    const Evidence* innovations = InnovationsOf(solution);
    ASSERT_NE(innovations, nullptr) << fault << " " << solution.verdict;
    EXPECT_GT(*innovations->value, kUnusableError) << fault;
    EXPECT_EQ(solution.grade, Grade::kDoubtful) << fault << solution.verdict;
  }
}

TEST(AttitudeJudgement, AFilterFarFromItsSmootherIsNotUsable) {
  const Solution solution = Filtered("negated", 0.0);
  ASSERT_NE(InnovationsOf(solution), nullptr) << solution.verdict;
  EXPECT_EQ(solution.grade, Grade::kUnusable) << solution.verdict;
}

TEST(AttitudeJudgement, AHealthyOneIsUsable) {
  Dataset dataset = Simulate(FindScenario("test_worn", {}), 11);
  ReconstructionOptions options;
  options.attitude_alone = true;
  options.method = "ahrs";
  const Solution solution = Solve(dataset, options);
  EXPECT_EQ(solution.grade, Grade::kUsable) << solution.verdict;
}

}  // namespace
}  // namespace hindsight
