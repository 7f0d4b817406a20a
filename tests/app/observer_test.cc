#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/recording.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;

TEST(ObserverCommand, RunTakesObserversAndErrorDefinitions) {
  Recording recording;
  const Outcome outcome =
      recording.Run({"--out=out", "--methods=ekf,hinf,modified_hinf,rts",
                     "--error=left_invariant", "--gamma=50", "--alpha=0.01"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json methods = nlohmann::json::parse(
      ReadFile(recording.root() / "out" / "summary.json"))["methods"];
  for (const char* method : {"ekf", "hinf", "modified_hinf", "rts"}) {
    EXPECT_TRUE(methods.contains(method)) << method;
    EXPECT_TRUE(std::filesystem::exists(recording.root() / "out" /
                                        (std::string(method) + ".csv")));
  }
}

TEST(ObserverCommand, AnEscapeIsReportedWithItsTimeAndLeavesTheOthers) {
  Recording recording;
  const Outcome outcome =
      recording.Run({"--out=out", "--methods=hinf,ekf", "--gamma=1e-4"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("hinf is not usable: the Riccati equation "
                                     "escapes to infinity at t = "));
  EXPECT_THAT(outcome.out, HasSubstr("ekf is usable"));
  const Outcome backed_off = recording.Run(
      {"--out=backed_off", "--methods=hinf", "--gamma=1e-4", "--back-off"});
  EXPECT_EQ(backed_off.status, 0) << backed_off.out;
}

TEST(ObserverCommand, MonteCarloWritesEveryCell) {
  TemporaryFolder folder;
  const Outcome outcome =
      Hindsight({"montecarlo", "in_flight_alignment", "--out=mc", "--runs=3",
                 "--rates=1", "--tilt=10", "--heading=30,120", "--gamma=1"},
                folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("left_invariant"));
  const nlohmann::json cells = nlohmann::json::parse(
      ReadFile(folder.path() / "mc" / "montecarlo.json"))["cells"];
  ASSERT_EQ(cells.size(), 2u * 4u * 3u);
  EXPECT_EQ(Lines(ReadFile(folder.path() / "mc" / "cells.csv")).size(), 25u);
  for (const nlohmann::json& cell : cells) {
    const bool escaped = cell["escaped"].get<double>() > 0.0;
    EXPECT_EQ(cell.contains("t_escape_s"), escaped);
    EXPECT_TRUE(escaped || cell["lyapunov"].contains("share_falling"));
  }
}

TEST(ObserverCommand, BadFlagsAreNamedInOneLine) {
  TemporaryFolder folder;
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"--gamma=-1", "--gamma=-1"},
      {"--gamma=wide", "--gamma=wide"},
      {"--error=euler", "known are navigation, quaternion, left_invariant"},
      {"--alpha=-0.1", "--alpha"},
      {"--alpha-blocks=some", "velocity_attitude or all"},
      {"--bounded=position", "attitude or velocity"},
      {"--bounded=attitude=3m", "--bounded=attitude=3m"},
      {"--rules=kalman", "expected some of ekf,hinf,modified_hinf"},
      {"--heading=0", "--heading=0"},
      {"--sweep", "tunnel_survey"}};
  for (const auto& [flag, expected] : cases) {
    const Outcome outcome = Hindsight(
        {"montecarlo", "in_flight_alignment", "--out=mc", flag}, folder.path());
    EXPECT_EQ(outcome.status, 2) << flag;
    EXPECT_THAT(outcome.err, HasSubstr(expected));
    EXPECT_EQ(Lines(outcome.err).size(), 1u) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "mc"));
  }
}

}  // namespace
}  // namespace hindsight
