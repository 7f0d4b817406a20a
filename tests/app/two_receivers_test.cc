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
                 const std::string& error, int seed = 41,
                 const std::string& set = "wander.seed=3") {
  const Outcome made = Hindsight(
      {"simulate", "two_receivers", "--seed=" + std::to_string(seed),
       "--set=start_errors.position=" + start, "--set=" + set, "--out=drive"},
      folder.path());
  EXPECT_EQ(made.status, 0) << made.err;
  Told told;
  told.outcome = Hindsight(
      {"run", "drive/config.yaml", "--methods=robust_batch",
       "--inject=" + error, "--seed=" + std::to_string(seed), "--out=result"},
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
  EXPECT_THAT(told.method()["found"].dump(),
              Not(HasSubstr("left: against the noise as stated")));
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

/// White noise takes what one of them is off for outliers: an error throughout is sought
/// from the noise a priori as well, so that both are told by errors of the same kind.
TEST(TwoReceivers, ThatAreBothOffThroughoutAreBothTold) {
  const TemporaryFolder folder;
  const Told told = RobustBatch(
      folder, "3 m", "right:step=5m,from=0s,axes=n;left:step=5m,from=0s,axes=e",
      22106, "wander.seed=22106");
  EXPECT_EQ(told.outcome.status, 3) << told.outcome.out << told.outcome.err;
  EXPECT_THAT(
      told.method()["evidence"].dump(),
      HasSubstr("which sensor errs cannot be told: right, or 1.5 % likely "
                "left: right: Gauss-Markov errors, 7.1 m throughout; left: "
                "Gauss-Markov errors, 7.1 m throughout"));
}

/// Also where the start is on the side of one of them by odds of more than a thousand:
/// both are off.
TEST(TwoReceivers, OfWhichTheStartAloneTellsAreDoubtful) {
  const TemporaryFolder folder;
  const Told told = RobustBatch(
      folder, "3 m", "left:step=3.5m,from=0s;right:step=-5m,from=0s", 61);
  EXPECT_EQ(told.outcome.status, 3) << told.outcome.out << told.outcome.err;
  EXPECT_THAT(told.method()["evidence"].dump(),
              HasSubstr("left is off from its first fix to its last against "
                        "right, and that it is not right, or both, nothing "
                        "but the start tells"));
}

}  // namespace
}  // namespace hindsight
