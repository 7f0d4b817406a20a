#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/recording.h"

namespace hindsight {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

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
  EXPECT_THAT(backed_off.out, ContainsRegex("hinf found no bounded gain at "
                                            "[0-9]+ of [0-9]+ steps"));
  const nlohmann::json figures = nlohmann::json::parse(
      ReadFile(recording.root() / "backed_off" /
               "summary.json"))["methods"]["hinf"]["observer"];
  EXPECT_EQ(figures["gamma_sqrt_s"], 1e-4);
  EXPECT_THAT(backed_off.out,
              HasSubstr("no bounded gain at " + figures["back_offs"].dump() +
                        " of " + figures["steps"].dump() + " steps"));
  EXPECT_GE(figures["least_information"], 0.5);
  EXPECT_FALSE(figures.contains("delta_per_s"));
}

TEST(ObserverCommand, SummaryHoldsTheRiccatiEquationOfEveryObserver) {
  Recording recording;
  ASSERT_EQ(recording
                .Run({"--out=out", "--methods=ekf,hinf,modified_hinf",
                      "--gamma=1", "--alpha=0.01", "--delta=-2"})
                .status,
            0);
  const nlohmann::json methods = nlohmann::json::parse(
      ReadFile(recording.root() / "out" / "summary.json"))["methods"];
  EXPECT_FALSE(methods["ekf"].contains("observer"));
  const nlohmann::json& hinf = methods["hinf"]["observer"];
  EXPECT_EQ(hinf["gamma_sqrt_s"], 1.0);
  EXPECT_EQ(hinf["back_offs"], 0);
  EXPECT_GT(hinf["steps"], 40);
  EXPECT_GT(hinf["least_information"], 0.0);
  EXPECT_LT(hinf["least_information"], 1.0);
  const nlohmann::json& modified = methods["modified_hinf"]["observer"];
  EXPECT_EQ(modified["alpha_per_s"], 0.01);
  EXPECT_EQ(modified["delta_per_s"], -2.0);
  EXPECT_EQ(modified["least_information"], 1.0);
  EXPECT_THAT(methods["hinf"]["verdict"].get<std::string>(),
              HasSubstr("P, which is no covariance"));
}

TEST(ObserverCommand, MonteCarloCountsTheStepsBackedOff) {
  TemporaryFolder folder;
  const Outcome outcome = Hindsight(
      {"montecarlo", "in_flight_alignment", "--out=mc", "--runs=2",
       "--set=aiding.velocity.rate=1 Hz", "--set=start_errors.tilt=30 deg",
       "--set=start_errors.heading=175 deg", "--methods=ekf,hinf",
       "--gamma=1,1e9", "--error=left_invariant", "--back-off"},
      folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("least"));
  const nlohmann::json cells = nlohmann::json::parse(
      ReadFile(folder.path() / "mc" / "montecarlo.json"))["cells"];
  ASSERT_EQ(cells.size(), 3u);
  EXPECT_EQ(cells[0]["backed_off"], 0.0);
  EXPECT_EQ(cells[0]["least_information"], 1.0);
  EXPECT_EQ(cells[1]["escaped"], 0.0);
  EXPECT_GT(cells[1]["backed_off"], 0.0);
  EXPECT_LT(cells[1]["backed_off"], 0.5);
  EXPECT_GE(cells[1]["least_information"], 0.5);
  EXPECT_LT(cells[1]["least_information"], 1.0);
  EXPECT_EQ(cells[2]["backed_off"], 0.0);
  EXPECT_THAT(ReadFile(folder.path() / "mc" / "cells.csv"),
              HasSubstr(",backed_off[1],least_information[1],"));
}

TEST(ObserverCommand, WhereAllRunsEscapeNoEmptyColumnIsPrinted) {
  TemporaryFolder folder;
  const Outcome outcome = Hindsight(
      {"montecarlo", "in_flight_alignment", "--out=mc", "--runs=2",
       "--set=aiding.velocity.rate=1 Hz", "--set=start_errors.tilt=10 deg",
       "--set=start_errors.heading=30 deg", "--methods=hinf", "--gamma=0.1",
       "--error=left_invariant"},
      folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("escaped"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("falling")));
}

TEST(ObserverCommand, MonteCarloWritesEveryCell) {
  TemporaryFolder folder;
  const Outcome outcome = Hindsight(
      {"montecarlo", "in_flight_alignment", "--out=mc", "--runs=3",
       "--set=aiding.velocity.rate=1 Hz", "--set=start_errors.tilt=10 deg",
       "--set=start_errors.heading=30 deg|120 deg", "--gamma=1"},
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
    EXPECT_TRUE(escaped || cell.contains("share_falling"));
  }
}

TEST(ObserverCommand, ParametersOfRulesThatDoNotRunAreRefused) {
  Recording recording;
  for (const char* flag : {"--gamma=5", "--alpha=0.1", "--alpha-blocks=all",
                           "--delta=1", "--bounded=velocity", "--back-off"}) {
    const Outcome outcome = recording.Run({"--out=out", "--methods=ekf", flag});
    EXPECT_EQ(outcome.status, 2) << flag;
    EXPECT_THAT(outcome.err, HasSubstr("which is not asked for"));
    EXPECT_EQ(Lines(outcome.err).size(), 1u) << outcome.err;
  }
  const Outcome montecarlo =
      Hindsight({"montecarlo", "in_flight_alignment", "--out=mc",
                 "--methods=modified_hinf", "--gamma=5"},
                recording.root());
  EXPECT_EQ(montecarlo.status, 2);
  EXPECT_THAT(montecarlo.err, HasSubstr("--gamma is of hinf"));
}

TEST(ObserverCommand, TheErrorDefinitionIsRefusedWhereItChangesNothing) {
  Recording recording;
  for (const char* methods :
       {"--methods=imm", "--methods=robust_batch,imm_smoother",
        "--methods=ahrs"}) {
    const Outcome outcome =
        recording.Run({"--out=out", methods, "--error=quaternion"});
    EXPECT_EQ(outcome.status, 2) << methods;
    EXPECT_THAT(outcome.err, HasSubstr("--error changes nothing in "));
    EXPECT_EQ(Lines(outcome.err).size(), 1u) << outcome.err;
  }
  ASSERT_EQ(recording.Run({"--out=a", "--methods=ekf,gated_ekf"}).status, 0);
  ASSERT_EQ(
      recording
          .Run({"--out=b", "--methods=ekf,gated_ekf", "--error=left_invariant"})
          .status,
      0);
  for (const char* file : {"ekf.csv", "gated_ekf.csv"}) {
    EXPECT_NE(ReadFile(recording.root() / "a" / file),
              ReadFile(recording.root() / "b" / file))
        << file;
  }
}

TEST(ObserverCommand, FlagsThatMeanNothingToAttitudeAloneAreRefused) {
  Recording recording;
  for (const char* flag :
       {"--without=gnss", "--withhold=gnss:every=9s,length=3s",
        "--inject=gnss:step=3m", "--seed=2", "--point=1,2,3", "--export=tum"}) {
    const Outcome outcome =
        recording.Run({"--out=out", "--methods=ahrs", flag});
    EXPECT_EQ(outcome.status, 2) << flag;
    EXPECT_THAT(outcome.err, HasSubstr("means nothing to ahrs"));
    EXPECT_EQ(Lines(outcome.err).size(), 1u) << outcome.err;
  }
}

TEST(ObserverCommand, AlignmentWithoutAStartIsTriedOnManySeeds) {
  TemporaryFolder folder;
  const Outcome outcome =
      Hindsight({"montecarlo", "velocity_alignment", "--out=mc", "--runs=10",
                 "--set=aiding.velocity.rate=1 Hz"},
                folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json cells = nlohmann::json::parse(
      ReadFile(folder.path() / "mc" / "montecarlo.json"))["cells"];
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_EQ(cells[0]["method"], "velocity_alignment");
  EXPECT_EQ(cells[0]["method"], "velocity_alignment");
  EXPECT_EQ(cells[0]["failed"], 0);
  EXPECT_LT(cells[0]["heading_rms_deg"], 0.2);
  const nlohmann::json& batch = cells[1];
  EXPECT_EQ(batch["method"], "velocity_alignment_batch");
  EXPECT_EQ(batch["failed"], 0);
  for (const std::string angle : {"tilt", "heading"}) {
    // Ten runs: 4 sigmas of a root mean square.
    const double rms = batch[angle + "_rms_deg"];
    const double sigma = batch[angle + "_sigma_deg"];
    EXPECT_GT(rms, 0.1 * sigma) << angle;
    EXPECT_LT(rms, (1.0 + 4.0 / std::sqrt(20.0)) * sigma) << angle;
    EXPECT_LT(sigma, 0.03) << angle;
    EXPECT_GE(batch[angle + "_worst_deg"], rms);
  }
}

TEST(ObserverCommand, AlignmentThatFindsNothingHasNoFigures) {
  TemporaryFolder folder;
  const Outcome outcome =
      Hindsight({"montecarlo", "velocity_alignment", "--out=mc", "--runs=2",
                 "--set=aiding.velocity.rate=0.01 Hz"},
                folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json cells = nlohmann::json::parse(
      ReadFile(folder.path() / "mc" / "montecarlo.json"))["cells"];
  ASSERT_EQ(cells.size(), 2u);
  for (const nlohmann::json& cell : cells) {
    EXPECT_EQ(cell["failed"], 2);
    EXPECT_FALSE(cell.contains("heading_rms_deg"));
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
      {"--methods=kalman", "none of the observers ekf,hinf,modified_hinf"},
      {"--set=start_errors.heading=0 deg", "start_errors.heading"},
      {"--set=start_errors.heading=190 deg", "at most 180 deg"},
      {"--set=aiding.velocity.rate=0 Hz", "aiding.velocity.rate"}};
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
