#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "app/command_line.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

struct Told {
  Outcome outcome;
  std::string summary;

  nlohmann::json method() const {
    return nlohmann::json::parse(summary)["methods"]["robust_batch"];
  }
  double horizontal_rms() const {
    return method()["error"]["horizontal_rms_m"].get<double>();
  }
};

Told RobustBatch(const TemporaryFolder& folder, const std::string& start,
                 const std::string& error) {
  const Outcome made =
      Hindsight({"simulate", "two_receivers", "--seed=41",
                 "--set=start_errors.position=" + start, "--out=drive"},
                folder.path());
  EXPECT_EQ(made.status, 0) << made.err;
  Told told;
  told.outcome =
      Hindsight({"run", "drive/config.yaml", "--methods=robust_batch",
                 "--inject=" + error, "--out=result"},
                folder.path());
  told.summary = ReadFile(folder.path() / "result/summary.json");
  return told;
}

/// Which of two receivers steps away is seen against the IMU.
TEST(TwoReceivers, TheOneThatStepsAwayIsFound) {
  const TemporaryFolder folder;
  const Told told = RobustBatch(folder, "0.5 m", "right:step=8m,from=80s");
  EXPECT_EQ(told.outcome.status, 0) << told.outcome.out << told.outcome.err;
  EXPECT_LT(told.horizontal_rms(), 0.4);
  EXPECT_THAT(told.method()["found"].dump(), HasSubstr("right: "));
  EXPECT_THAT(told.method()["found"].dump(), Not(HasSubstr("left: ")));
}

/// Which of two receivers is off from the first fix to the last nothing tells,
/// where the start is not known better than they differ.
TEST(TwoReceivers, ThatDifferThroughoutAreBothTold) {
  const TemporaryFolder folder;
  const Told told = RobustBatch(folder, "20 m", "right:step=4m,from=0s");
  EXPECT_EQ(told.outcome.status, 3) << told.outcome.out << told.outcome.err;
  EXPECT_THAT(told.outcome.out, HasSubstr("which sensor errs cannot be told"));
  EXPECT_THAT(told.method()["found"].dump(),
              ::testing::AllOf(HasSubstr("left: "), HasSubstr("right: "),
                               HasSubstr("% likely")));
  // 4 m north and east between them: the chosen one may be the wrong one.
  EXPECT_LT(told.method()["nees"]["position"].get<double>(), 16.3);
}

}  // namespace
}  // namespace hindsight
