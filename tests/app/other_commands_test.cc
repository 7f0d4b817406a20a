#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/recording.h"

namespace hindsight {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class OtherCommands : public ::testing::Test {
 protected:
  nlohmann::json Summary() const {
    return nlohmann::json::parse(
        ReadFile(recording_.root() / "out" / "summary.json"));
  }
  Recording recording_;
};

TEST_F(OtherCommands, CheckReportsAndChangesNothing) {
  const std::vector<std::string> before = Names(recording_.root() / "data");
  const Outcome outcome =
      Hindsight({"check", "data/config.yaml"}, recording_.root());
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("imu"));
  EXPECT_THAT(outcome.out, HasSubstr("Hz"));
  EXPECT_EQ(Lines(outcome.out).back(),
            "the recording is usable: nothing looks wrong");
  EXPECT_EQ(Names(recording_.root() / "data"), before);
  EXPECT_THAT(Names(recording_.root()), ElementsAre("data"));
}

TEST_F(OtherCommands, CheckWritesTheNoiseThatItFinds) {
  recording_.Replace("config.yaml", "  gnss:\n",
                     "  gnss:\n    sigma_scale: 5  # as it may be\n");
  const std::string before = ReadFile(recording_.file("config.yaml"));
  EXPECT_EQ(
      Hindsight({"check", "data/config.yaml", "--write"}, recording_.root())
          .status,
      2);
  const std::vector<std::string> words = {"check", "data/config.yaml",
                                          "--noise", "--write"};
  const Outcome outcome = Hindsight(words, recording_.root());
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("wrote to data/config.yaml: "));
  const std::string after = ReadFile(recording_.file("config.yaml"));
  EXPECT_THAT(after, HasSubstr("    # check --noise: sigma_scale was 5, "));
  EXPECT_THAT(after, HasSubstr("  # as it may be\n"));
  const std::size_t at = after.find("    sigma_scale: ");
  ASSERT_NE(at, after.npos);
  // Fifty fixes of three components tell a sigma to 6 %.
  EXPECT_NEAR(std::stod(after.substr(at + 17)), 1.0, 4.0 * 0.06);
  EXPECT_EQ(Lines(after).size(), Lines(before).size() + 1);
  const Outcome again = Hindsight(words, recording_.root());
  EXPECT_THAT(again.out, HasSubstr("nothing to write"));
}

/// A device's noise is no key that could be exchanged: what is found goes before it.
TEST_F(OtherCommands, CheckWritesNoiseBesideThatOfADevice) {
  recording_.Edit("config.yaml", [](std::vector<std::string>* lines) {
    const auto noise = std::find(lines->begin(), lines->end(), "  noise:");
    ASSERT_NE(noise, lines->end());
    auto end = noise + 1;
    while (end != lines->end() && end->starts_with("    ")) ++end;
    lines->erase(noise + 1, end);
    *noise = "  noise: {like: MTi-300}";
  });
  const Outcome outcome = Hindsight(
      {"check", "data/config.yaml", "--noise", "--write"}, recording_.root());
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("imu.accel"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("to be written by hand")));
  const std::string after = ReadFile(recording_.file("config.yaml"));
  EXPECT_THAT(after, HasSubstr("like: MTi-300"));
  EXPECT_THAT(after, HasSubstr("check --noise: accel was "));
  EXPECT_EQ(Hindsight({"check", "data/config.yaml"}, recording_.root()).status,
            0);
}

TEST_F(OtherCommands, CheckEndsWithThreeWhereTheImuFreezes) {
  const std::size_t first = recording_.FirstRow("imu.csv");
  recording_.Edit("imu.csv", [first](std::vector<std::string>* lines) {
    const std::string& held = (*lines)[first + 2000];
    const std::string readings = held.substr(held.find(','));
    for (std::size_t i = first + 2001; i < first + 2500; ++i) {
      std::string& line = (*lines)[i];
      line = line.substr(0, line.find(',')) + readings;
    }
  });
  const Outcome outcome =
      Hindsight({"check", "data/config.yaml"}, recording_.root());
  EXPECT_EQ(outcome.status, 3) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("imu repeats one reading for 4.99 s"));
  EXPECT_EQ(Lines(outcome.out).back(), "the recording is doubtful: 1 warning");
}

/// Figures of `evaluate` in the words of summary.json.
nlohmann::json ErrorsOf(const nlohmann::json& figures) {
  const nlohmann::json& errors = figures["errors"];
  return {{"horizontal_rms_m", errors["position_horizontal"]["rms"]},
          {"horizontal_max_m", errors["position_horizontal"]["max"]},
          {"total_rms_m", errors["position_total"]["rms"]},
          {"matched_percent", figures["matched_percent"]}};
}

TEST_F(OtherCommands, EvaluatePrintsTheFiguresOfRun) {
  // Nodes a second apart, ten rows a second, and another point of the vehicle:
  // the truth stands ten times a second.
  const std::vector<std::vector<std::string>> outputs = {
      {}, {"--rate=7"}, {"--point=1,0.5,-2"}};
  for (std::vector<std::string> flags : outputs) {
    flags.insert(flags.end(), {"--out=out", "--methods=ekf,batch", "--force"});
    ASSERT_EQ(recording_.Run(flags).status, 0);
    for (const std::string method : {"ekf", "batch"}) {
      const Outcome outcome = Hindsight(
          {"evaluate", "out/" + method + ".csv", "data/truth.csv", "--json"},
          recording_.root());
      ASSERT_EQ(outcome.status, 0) << outcome.err;
      const nlohmann::json figures = nlohmann::json::parse(outcome.out);
      EXPECT_EQ(figures["at"], "truth points");
      EXPECT_EQ(figures["truth_count"], 501);
      const nlohmann::json summary = Summary()["methods"][method];
      const nlohmann::json errors = ErrorsOf(figures);
      for (const auto& [key, value] : errors.items()) {
        // The files' decimals: 1e-7 m.
        EXPECT_NEAR(value.get<double>(), summary["error"][key].get<double>(),
                    3e-7)
            << method << " " << key;
      }
      EXPECT_NEAR(figures["nees"]["position"].get<double>(),
                  summary["nees"]["position"].get<double>(), 1e-4);
    }
  }
}

TEST_F(OtherCommands, EvaluateSaysWhereItCompares) {
  ASSERT_EQ(recording_.Run({"--out=out", "--methods=batch"}).status, 0);
  const auto evaluate = [&](const std::string& solution) {
    return Hindsight({"evaluate", solution, "data/truth.csv"},
                     recording_.root())
        .out;
  };
  EXPECT_THAT(evaluate("out/batch.csv"),
              HasSubstr("compared: out/batch.truth.csv with data/truth.csv\n"));
  // Taken from its folder it is only its rows.
  std::filesystem::copy(recording_.root() / "out" / "batch.csv",
                        recording_.root() / "alone.csv");
  const std::string alone = evaluate("alone.csv");
  EXPECT_THAT(alone, HasSubstr("compared: alone.csv with data/truth.csv\n"));
  EXPECT_THAT(alone, HasSubstr("rows of the solution, to which the denser "
                               "truth is interpolated"));
  EXPECT_THAT(evaluate("data/truth.csv"),
              HasSubstr("501 of 501 truth points (100.00 %)"));
}

TEST_F(OtherCommands, EvaluateTakesTheTruthOfAConfiguration) {
  ASSERT_EQ(recording_.Run({"--out=out", "--methods=batch"}).status, 0);
  const auto evaluate = [&](const std::string& truth) {
    return nlohmann::json::parse(
        Hindsight({"evaluate", "out/batch.csv", truth, "--json"},
                  recording_.root())
            .out);
  };
  const auto total = [&](const std::string& truth) {
    const nlohmann::json figures = evaluate(truth);
    return figures["errors"]["position_total"]["rms"].get<double>();
  };
  EXPECT_NEAR(total("data/config.yaml"), total("data/truth.csv"), 1e-8);
}

TEST_F(OtherCommands, InitWritesAConfigurationThatRuns) {
  std::filesystem::remove(recording_.file("config.yaml"));
  ASSERT_EQ(
      Hindsight({"init", "data", "--out=data/config.yaml"}, recording_.root())
          .status,
      0);
  const Outcome again =
      Hindsight({"init", "data", "--out=data/config.yaml"}, recording_.root());
  EXPECT_EQ(again.status, 2);
  EXPECT_THAT(again.err, HasSubstr("--force"));
  // A draft knows no lever arm, which the result may say.
  const Outcome outcome = recording_.Run({"--out=out", "--methods=rts"});
  EXPECT_THAT(outcome.status, ::testing::AnyOf(0, 3)) << outcome.err;
}

TEST_F(OtherCommands, InitWithoutAnImuIsBadInputThatNamesWhatThereIs) {
  std::filesystem::remove(recording_.file("imu.csv"));
  const Outcome outcome = Hindsight({"init", "data"}, recording_.root());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("data: no IMU was recognised among"));
  EXPECT_THAT(outcome.err, HasSubstr("gnss.csv (position)"));
  EXPECT_THAT(outcome.out, ::testing::IsEmpty());
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
}

TEST_F(OtherCommands, RunOfAFolderIsDoubtfulUntilConfirmed) {
  std::filesystem::remove(recording_.file("config.yaml"));
  const std::vector<std::string> words = {"run", "data", "--out=out",
                                          "--methods=batch"};
  const Outcome first = Hindsight(words, recording_.root());
  EXPECT_EQ(first.status, 3) << first.err;
  EXPECT_THAT(first.out, HasSubstr("taken for granted: "));
  EXPECT_THAT(first.out, HasSubstr("not confirmed"));
  // What it drafted is a configuration of its own, which --yes confirms.
  const Outcome again = Hindsight(
      {"run", "out.yaml", "--out=confirmed", "--methods=batch", "--yes"},
      recording_.root());
  EXPECT_THAT(again.out, ::testing::Not(HasSubstr("not confirmed")));
}

TEST_F(OtherCommands, OmittedSpansAreNeitherUsedNorJudged) {
  const Outcome outcome =
      recording_.Run({"--out=out", "--methods=batch", "--omit=gnss:10..20",
                      "--omit=gnss:25 s..30 s"});
  ASSERT_THAT(outcome.status, ::testing::AnyOf(0, 3)) << outcome.err;
  std::istringstream rows(ReadFile(recording_.root() / "out" / "fixes.csv"));
  int inside = 0;
  int rest = 0;
  for (std::string row; std::getline(rows, row);) {
    if (row.find_first_of("0123456789") != 0) continue;
    const double t = std::stod(row);
    const bool omitted = (t >= 10.0 && t < 20.0) || (t >= 25.0 && t < 30.0);
    (omitted ? inside : rest) += 1;
  }
  EXPECT_EQ(inside, 0);
  EXPECT_GT(rest, 30);
  const Outcome none = recording_.Run({"--out=none", "--omit=gnss:900..950"});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("holds no measurement"));
  EXPECT_EQ(recording_.Run({"--out=none", "--omit=gnss"}).status, 2);
}

TEST_F(OtherCommands, SimulateEndsEarlier) {
  ASSERT_EQ(
      Hindsight({"simulate", "short_drive", "--out=whole"}, recording_.root())
          .status,
      0);
  ASSERT_EQ(Hindsight({"simulate", "short_drive", "--out=part", "--duration=9"},
                      recording_.root())
                .status,
            0);
  const std::string whole = ReadFile(recording_.root() / "whole" / "imu.csv");
  const std::string part = ReadFile(recording_.root() / "part" / "imu.csv");
  EXPECT_EQ(std::count(part.begin(), part.end(), '\n'), 1 + 900);
  EXPECT_TRUE(whole.starts_with(part));
  // The errors of this one's positions would begin at 120 s.
  EXPECT_EQ(Hindsight({"simulate", "gps_jumps", "--out=quiet", "--duration=5"},
                      recording_.root())
                .status,
            0);
  const Outcome beyond =
      Hindsight({"simulate", "short_drive", "--out=all", "--duration=9999"},
                recording_.root());
  EXPECT_THAT(beyond.out, HasSubstr("the scenario ends after 180 s, before "
                                    "the 9999 s of --duration"));
  EXPECT_EQ(ReadFile(recording_.root() / "all" / "imu.csv"), whole);
  const Outcome never =
      Hindsight({"simulate", "short_drive", "--out=no", "--duration=0"},
                recording_.root());
  EXPECT_EQ(never.status, 2);
  EXPECT_THAT(never.err, HasSubstr("--duration"));
}

TEST_F(OtherCommands, SimulateIsReproducible) {
  for (const std::string out : {"first", "second"}) {
    ASSERT_EQ(Hindsight({"simulate", "short_drive", "--out=" + out, "--seed=3"},
                        recording_.root())
                  .status,
              0);
  }
  for (const std::string& name : Names(recording_.root() / "first")) {
    EXPECT_EQ(ReadFile(recording_.root() / "first" / name),
              ReadFile(recording_.root() / "second" / name));
  }
}

}  // namespace
}  // namespace hindsight
