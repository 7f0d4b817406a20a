#include "problems/montecarlo.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <mutex>
#include <set>
#include <stdexcept>

#include "base/error.h"
#include "evaluation/statistics.h"
#include "support/study.h"

namespace hindsight {
namespace {

using ::testing::ElementsAre;

StudyTable SeedTable() {
  return {
      "cells", {"case"}, {{"seed", kPlain, OfRuns(Mean)}, FailedFigure()}, {}};
}

/// It needs no recording.
Case Seeds(const std::string& name,
           const std::function<void(std::uint64_t)>& before = {}) {
  const auto run = [before](const Dataset&, CaseRun* of_case) {
    if (before) before(of_case->seed);
    RunRecord* record = of_case->Add(0, {});
    record->values = {{"seed", static_cast<double>(of_case->seed)}};
    record->t = {0.0};
    record->series["e"] = {1.0};
  };
  return {{name}, {}, {{}, run}};
}

TEST(StudyRun, MakesARowOfEveryCaseAndSeedInTheirOrder) {
  const Study study = {"", {}, {SeedTable()}, {Seeds("a"), Seeds("b")}};
  for (const int threads : {1, 3}) {
    const StudyResult result = testing::RunStudy(
        study, {.runs = 5, .first_seed = 7, .threads = threads});
    EXPECT_TRUE(result.complete);
    EXPECT_EQ(result.runs, 5);
    ASSERT_EQ(result.records.size(), 10u);
    for (std::size_t i = 0; i < 10; ++i) {
      EXPECT_EQ(result.records[i].labels[0], i < 5 ? "a" : "b");
      EXPECT_EQ(result.records[i].seed, 7 + i % 5);
      EXPECT_TRUE(result.records[i].series.empty());
    }
    EXPECT_EQ(testing::ValueOf(result, {"b"}, "seed"), 9.0);
  }
}

/// A case whose recordings of these seeds cannot be made, by two methods of
/// which the second refuses seed 4.
Case Refusing(const std::string& name, const std::set<std::uint64_t>& seeds) {
  const Recording recording = [seeds](std::uint64_t seed) {
    if (seeds.contains(seed)) throw InputError("no such recording");
    Dataset dataset;
    dataset.max_node_spacing = static_cast<double>(seed);
    return dataset;
  };
  const std::vector<std::string> methods = {"first", "second"};
  const auto run = [methods](const Dataset& dataset, CaseRun* of_case) {
    for (const std::string& method : methods) {
      of_case->Try({method}, [&](RunRecord* record) {
        if (method == "second" && dataset.max_node_spacing == 4.0) {
          throw InputError("not for me");
        }
        record->values = {{"seed", dataset.max_node_spacing}};
      });
    }
  };
  return {{name}, [recording] { return recording; }, {Named(methods), run}};
}

TEST(StudyRun, ARefusedRecordingIsAFailedRunOfEveryMethodAndIsNamed) {
  StudyTable table = SeedTable();
  table.labels = {"case", "method"};
  const StudyResult result = testing::RunStudy(
      {"", {}, {table}, {Refusing("a", {1, 3}), Refusing("b", {})}},
      {.runs = 5});
  EXPECT_TRUE(result.complete);
  ASSERT_EQ(result.rows[0].size(), 4u);
  EXPECT_EQ(testing::RowOf(result, {"a", "first"}).runs, 5);
  EXPECT_EQ(testing::ValueOf(result, {"a", "first"}, "failed"), 2);
  EXPECT_EQ(testing::ValueOf(result, {"a", "second"}, "failed"), 3);
  EXPECT_EQ(testing::ValueOf(result, {"b", "first"}, "failed"), 0);
  EXPECT_EQ(testing::ValueOf(result, {"a", "first"}, "seed"), 11.0 / 3.0);
  EXPECT_THAT(result.refusals,
              ElementsAre("a, first, seed 1: no such recording",
                          "a, second, seed 1: no such recording",
                          "a, first, seed 3: no such recording",
                          "a, second, seed 3: no such recording",
                          "a, second, seed 4: not for me",
                          "b, second, seed 4: not for me"));
}

TEST(StudyRun, WhereAllIsRefusedThatIsTheError) {
  StudyTable table = SeedTable();
  table.labels = {"case", "method"};
  EXPECT_THROW(testing::RunStudy({"", {}, {table}, {Refusing("a", {1, 2})}},
                                 {.runs = 2}),
               InputError);
}

TEST(StudyRun, OfOneCaseTheFirstSeedsAreKnownMeanwhile) {
  const StudyRun* work = nullptr;
  std::vector<int> known;
  const Study study = {"", {}, {SeedTable()}, {Seeds("a", [&](std::uint64_t) {
                         const StudyResult result = work->SoFar();
                         EXPECT_FALSE(result.complete);
                         EXPECT_EQ(result.records.size(),
                                   static_cast<std::size_t>(result.runs));
                         known.push_back(result.runs);
                       })}};
  StudyRun run(study, {.runs = 3}, 0, 3);
  work = &run;
  run.Do();
  EXPECT_THAT(known, ElementsAre(0, 1, 2));
  EXPECT_TRUE(run.SoFar().complete);
}

TEST(StudyRun, OfSeveralCasesTheFinishedAreKnownMeanwhile) {
  const StudyRun* work = nullptr;
  std::vector<std::size_t> rows;
  const auto look = [&](std::uint64_t) {
    rows.push_back(work->SoFar().rows[0].size());
  };
  const Study study = {
      "", {}, {SeedTable()}, {Seeds("a", look), Seeds("b", look)}};
  StudyRun run(study, {.runs = 2}, 0, 2);
  work = &run;
  run.Do();
  EXPECT_THAT(rows, ElementsAre(0, 0, 1, 1));
}

TEST(StudyRun, TheFirstExceptionStopsTheRest) {
  std::mutex mutex;
  int count = 0;
  const Study study = {"", {}, {SeedTable()}, {Seeds("a", [&](std::uint64_t) {
                         const std::lock_guard lock(mutex);
                         ++count;
                         throw std::runtime_error("no");
                       })}};
  EXPECT_THROW(testing::RunStudy(study, {.runs = 1000, .threads = 2}),
               std::runtime_error);
  EXPECT_LE(count, 4);
}

}  // namespace
}  // namespace hindsight
