#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/command_line.h"

namespace hindsight {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const std::string kCorners =
    std::string(HINDSIGHT_SOURCE_DIR) + "/data/scenarios/corners.yaml";

std::vector<std::string> Words(const std::string& out,
                               const std::string& threads) {
  return {"montecarlo",          kCorners,
          "short_drive",         "--runs=3",
          "--out=" + out,        "--methods=ekf,rts",
          "--threads=" + threads};
}

TEST(MonteCarloScenarios, AnyScenariosAreComparedByAnyMethods) {
  const TemporaryFolder folder;
  const Outcome outcome = Hindsight(Words("mc", "2"), folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("corners"), HasSubstr("anees"),
                                 HasSubstr("position")));
  EXPECT_THAT(Names(folder.path() / "mc"),
              ElementsAre("cells.csv", "curves.csv", "manifest.json",
                          "montecarlo.json", "runs.csv"));
  const nlohmann::json json =
      nlohmann::json::parse(ReadFile(folder.path() / "mc" / "montecarlo.json"));
  EXPECT_EQ(json["complete"], true);
  ASSERT_THAT(json["cells"], SizeIs(4));
  for (const nlohmann::json& cell : json["cells"]) {
    EXPECT_EQ(cell["failed"], 0);
    EXPECT_EQ(cell["grades_usable"].get<int>() +
                  cell["grades_doubtful"].get<int>() +
                  cell["grades_not_usable"].get<int>(),
              3);
    EXPECT_LT(cell["anees_bound_lower"], cell["states"]);
    EXPECT_GT(cell["anees_bound_upper"], cell["states"]);
    EXPECT_LT(cell["position_rms_m"], 2.0);
  }
  EXPECT_EQ(json["cells"][0]["scenario"], "corners");
  EXPECT_EQ(json["cells"][3]["method"], "rts");
  const std::vector<std::string> runs =
      Lines(ReadFile(folder.path() / "mc" / "runs.csv"));
  EXPECT_THAT(runs, SizeIs(1 + 2 * 2 * 3));
  EXPECT_THAT(runs[0], HasSubstr("scenario,method,seed,grade,failed,"));
}

TEST(MonteCarloScenarios, FilesAreTheSameForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  ASSERT_EQ(Hindsight(Words("one", "1"), folder.path()).status, 0);
  ASSERT_EQ(Hindsight(Words("three", "3"), folder.path()).status, 0);
  for (const char* name : {"cells.csv", "curves.csv", "runs.csv"}) {
    EXPECT_EQ(ReadFile(folder.path() / "one" / name),
              ReadFile(folder.path() / "three" / name))
        << name;
  }
}

TEST(MonteCarloScenarios, WhatCannotBeComparedIsRefused) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"short_drive", "--methods=none"}, "--methods=none"},
      {{"short_drive", "--methods=ahrs"}, "'ahrs' is for attitude alone"},
      {{"short_drive", "--methods="}, "expected some of"},
      {{"short_drive", "short_drive"}, "two scenarios of the name"},
      {{"short_drive", "long_drive"}, "finds no file 'long_drive'"},
      {{"short_drive", "--error=navigation"},
       "--error means nothing to short_drive"},
      {{"short_drive", "--set=aiding.gnss.sigma=1 s"}, "expected a length"},
      {{"gps_jumps", "--set=aiding.*.rate=3 Hz", "--set=errors=none",
        "--runs=2"},
       "kf0, seed 1: data set 'gps_jumps' has no truth at"}};
  for (const auto& [words, expected] : cases) {
    const TemporaryFolder folder;
    std::vector<std::string> all = {"montecarlo", "--out=mc"};
    all.insert(all.end(), words.begin(), words.end());
    const Outcome outcome = Hindsight(all, folder.path());
    EXPECT_EQ(outcome.status, 2) << expected;
    EXPECT_THAT(outcome.err, HasSubstr(expected));
    EXPECT_THAT(Names(folder.path()), IsEmpty());
  }
}

TEST(MonteCarloScenarios, ValuesOfAKeyAreCases) {
  const TemporaryFolder folder;
  const Outcome outcome = Hindsight(
      {"montecarlo", "short_drive", "--runs=2", "--out=mc", "--methods=ekf",
       "--set=aiding.gnss.sigma=0.1 m|2 m", "--set=truth_rate=1 Hz"},
      folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json json =
      nlohmann::json::parse(ReadFile(folder.path() / "mc" / "montecarlo.json"));
  EXPECT_EQ(json["truth_rate"], "1 Hz");
  ASSERT_THAT(json["cells"], SizeIs(2));
  EXPECT_EQ(json["cells"][0]["aiding.gnss.sigma"], "0.1 m");
  EXPECT_LT(json["cells"][0]["position_rms_m"],
            json["cells"][1]["position_rms_m"]);
}

/// An axis that a comparison brings.
TEST(MonteCarloScenarios, ACaseIsChosenByTheAxisOfAComparison) {
  const TemporaryFolder folder;
  const Outcome outcome =
      Hindsight({"montecarlo", "tunnel_survey", "--runs=2", "--out=mc",
                 "--set=aiding.odometer.form=forward"},
                folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json json =
      nlohmann::json::parse(ReadFile(folder.path() / "mc" / "montecarlo.json"));
  std::vector<std::string> methods;
  for (const nlohmann::json& cell : json["cells"]) {
    EXPECT_FALSE(cell.contains("aiding.odometer.form"));
    methods.push_back(cell["method"]);
  }
  EXPECT_THAT(methods,
              ElementsAre("ekf", "two_filter", "two_filter_conventional",
                          "two_filter_euler", "rts", "iterated", "batch"));
}

TEST(MonteCarloScenarios, TheFolderOfAScenarioIsNotReplaced) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "in");
  WriteFile(folder.path() / "in" / "a.yaml", ReadFile(kCorners));
  const Outcome outcome =
      Hindsight({"montecarlo", "in/a.yaml", "--runs=2", "--out=in", "--force"},
                folder.path());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "in" / "a.yaml"));
}

TEST(MonteCarloGrades, CountsWhatIsWrongAndWhatIsSaidOfIt) {
  const TemporaryFolder folder;
  WriteFile(folder.path() / "faults.yaml",
            "scenarios: [test_hand]\nfaults:\n"
            "  - {fault: negated, sensor: position, sizes: [0]}\n"
            "  - {fault: delay, sensor: dvl, sizes: [1 s]}\n"
            "  - {fault: accel_unit, sizes: [9.80665]}\n");
  const Outcome outcome =
      Hindsight({"montecarlo", "grades", "--faults=faults.yaml", "--runs=2",
                 "--methods=batch", "--out=mc"},
                folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("test_hand, healthy"),
                    HasSubstr("wrong, visible"), HasSubstr("no answer")));
  EXPECT_THAT(Names(folder.path() / "mc"),
              ::testing::IsSupersetOf({"faults.csv", "summary.csv",
                                       "evidence.csv", "montecarlo.json"}));
  const std::string faults = ReadFile(folder.path() / "mc" / "faults.csv");
  EXPECT_THAT(faults, HasSubstr("position negated,0,batch,2,0,0,2,2,2,0"));
  EXPECT_THAT(faults, HasSubstr("position negated,0,run,2,0,0,2,2,2,0"));
  EXPECT_THAT(faults, ::testing::Not(HasSubstr("dvl")));
}

TEST(MonteCarloGrades, CountsAttitudeAloneByItsAttitudes) {
  const TemporaryFolder folder;
  WriteFile(folder.path() / "faults.yaml",
            "scenarios: [test_worn]\nfaults:\n"
            "  - {fault: gyro_unit, sizes: [57.29578]}\n"
            "  - {fault: imu_gap, sizes: [0.1 s]}\n"
            "  - {fault: delay, sensor: velocity, sizes: [1 s]}\n");
  const Outcome outcome =
      Hindsight({"montecarlo", "grades", "--faults=faults.yaml", "--runs=2",
                 "--methods=ahrs,ahrs_smoother", "--out=mc"},
                folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string faults = ReadFile(folder.path() / "mc" / "faults.csv");
  for (const char* method : {"ahrs", "ahrs_smoother", "run"}) {
    EXPECT_THAT(faults, HasSubstr(std::string("gyro_unit,57.29578,") + method +
                                  ",2,0,0,2,2,2,0"));
    EXPECT_THAT(faults, HasSubstr(std::string("imu_gap,0.1 s,") + method +
                                  ",2,2,0,0,0,0,0"));
  }
  EXPECT_THAT(faults, ::testing::Not(HasSubstr("velocity")));
}

TEST(MonteCarloGrades, RefusesMethodsOfBothKinds) {
  const TemporaryFolder folder;
  const Outcome outcome =
      Hindsight({"montecarlo", "grades", "--methods=ahrs,batch", "--out=mc"},
                folder.path());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--methods=ahrs,batch"));
}

TEST(MonteCarloGrades, BadCasesAreOneLine) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& faults) {
    WriteFile(folder.path() / "faults.yaml", faults);
    const Outcome outcome =
        Hindsight({"montecarlo", "grades", "--faults=faults.yaml", "--runs=2",
                   "--out=mc"},
                  folder.path());
    EXPECT_EQ(outcome.status, 2);
    return outcome.err;
  };
  const std::string car = "scenarios: [test_car]\nfaults:\n  - ";
  EXPECT_THAT(error(car + "{fault: dealy, sensor: position, sizes: [1 s]}\n"),
              AllOf(HasSubstr("faults.yaml:3"), HasSubstr("'dealy'")));
  EXPECT_THAT(error(car + "{fault: delay, sensor: gps, sizes: [1 s]}\n"),
              HasSubstr("no type of sensor"));
  EXPECT_THAT(error(car + "{fault: delay, sensor: position, sizes: [1 m]}\n"),
              HasSubstr("faults.sizes"));
  EXPECT_THAT(error(car + "{fault: sigma, sensor: position, sizes: [much]}\n"),
              HasSubstr("'much': expected a factor"));
  for (const char* fault : {"stale, sensor: position, sizes: [0]",
                            "negated, sensor: position, sizes: [3]",
                            "sigma, sensor: position, sizes: [-1]"}) {
    EXPECT_THAT(error(car + "{fault: " + fault + "}\n"),
                HasSubstr("expected a"));
  }
  EXPECT_THAT(error("scenarios: [no_such]\nfaults: []\n"),
              HasSubstr("no_such"));
}

}  // namespace
}  // namespace hindsight
