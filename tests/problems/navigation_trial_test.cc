#include "problems/navigation_trial.h"

#include <gtest/gtest.h>

#include "io/config/scenario_config.h"

namespace hindsight {
namespace {

const RunRecord& CellOf(const std::deque<RunRecord>& records,
                        const std::string& method) {
  for (const RunRecord& record : records) {
    if (record.table == kCells && record.labels.back() == method) return record;
  }
  throw std::out_of_range(method);
}

std::deque<RunRecord> Tried(const Dataset& dataset,
                            const std::vector<std::string>& methods) {
  CaseRun run = {{}, 1};
  NavigationTrialOf(
      {.methods = methods, .judged_every = 1.0, .best_of_run = true})
      .run(dataset, &run);
  return run.records;
}

Dataset JudgedDrive() {
  Scenario scenario = FindScenario("car_drive");
  scenario.duration = 60.0;
  scenario.withholdings.clear();
  return Simulate(scenario, 1);
}

TEST(NavigationTrial, TheRunIsItsBestMethod) {
  const std::deque<RunRecord> records =
      Tried(JudgedDrive(), {"ekf", "rts", "batch"});
  const RunRecord& run = CellOf(records, kBestOfRun);
  const RunRecord& batch = CellOf(records, "batch");
  EXPECT_EQ(run.grade, batch.grade);
  EXPECT_EQ(run.values, batch.values);
  EXPECT_NE(run.values, CellOf(records, "rts").values);
}

TEST(NavigationTrial, ARunWithoutAnAnswerHasFailed) {
  const std::deque<RunRecord> records = Tried(JudgedDrive(), {});
  const RunRecord& run = CellOf(records, kBestOfRun);
  EXPECT_TRUE(run.failed);
  EXPECT_FALSE(run.answered);
  EXPECT_EQ(run.grade, Grade::kUnusable);
}

}  // namespace
}  // namespace hindsight
