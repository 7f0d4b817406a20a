#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/recording.h"

namespace hindsight {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Gt;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;
using ::testing::UnorderedElementsAre;

/// The rows of a result file without comments and header.
std::vector<std::string> Rows(const std::filesystem::path& path) {
  std::vector<std::string> rows;
  for (const std::string& line : Lines(ReadFile(path))) {
    if (line.find_first_of("0123456789+-") == 0) rows.push_back(line);
  }
  return rows;
}

double Field(const std::string& row, std::size_t column) {
  std::istringstream in(row);
  std::string field;
  for (std::size_t i = 0; i <= column; ++i) std::getline(in, field, ',');
  return std::stod(field);
}

class RunCommandTest : public ::testing::Test {
 protected:
  std::filesystem::path Result(const std::string& name) const {
    return recording_.root() / "out" / name;
  }
  nlohmann::json Summary() const {
    return nlohmann::json::parse(ReadFile(Result("summary.json")));
  }
  Recording recording_;
};

TEST_F(RunCommandTest, WritesTheFilesOfEveryMethodAndNothingElse) {
  const Outcome outcome = recording_.Run({"--out=out", "--export=tum,kml,nav"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  std::vector<std::string> expected = {"config.resolved.yaml", "fixes.csv",
                                       "manifest.json", "residuals.csv",
                                       "summary.json"};
  for (const std::string method : {"ekf", "rts", "iterated", "batch"}) {
    for (const std::string ending : {"csv", "truth.csv", "errors.csv",
                                     "motion.csv", "tum", "kml", "nav"}) {
      expected.push_back(method + "." + ending);
    }
  }
  EXPECT_THAT(Names(recording_.root() / "out"),
              ::testing::UnorderedElementsAreArray(expected));
  EXPECT_THAT(Names(recording_.root()), UnorderedElementsAre("data", "out"));
  const std::vector<std::string> lines = Lines(outcome.out);
  EXPECT_THAT(lines.back(), StartsWith("batch is usable"));
  for (const std::string method : {"ekf", "rts", "iterated", "batch"}) {
    EXPECT_THAT(lines, Contains(StartsWith(method)));
  }
}

TEST_F(RunCommandTest, RowsAtTheTruthsTimesAreTheSameWhateverIsWrittenBeside) {
  // Rows of the truth are all among those at 100 Hz, some among those at 1 Hz.
  const auto truth_rows = [this](const std::vector<std::string>& flags) {
    std::vector<std::string> all = {"--out=out", "--methods=rts", "--force"};
    all.insert(all.end(), flags.begin(), flags.end());
    const Outcome outcome = recording_.Run(all);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return ReadFile(Result("rts.truth.csv"));
  };
  const std::string alone = truth_rows({});
  EXPECT_EQ(truth_rows({"--rate=1"}), alone);
  EXPECT_EQ(truth_rows({"--rate=100", "--export=npz"}), alone);
  EXPECT_EQ(truth_rows({"--rate=100", "--threads=1"}), alone);
  EXPECT_EQ(truth_rows({"--rate=100"}), alone);
  const std::vector<std::string> truth = Rows(Result("rts.truth.csv"));
  EXPECT_THAT(truth, SizeIs(Gt(10)));
  EXPECT_THAT(Rows(Result("rts.csv")), IsSupersetOf(truth));
}

TEST_F(RunCommandTest, SummaryHoldsTheDocumentedKeys) {
  ASSERT_EQ(recording_.Run({"--out=out", "--methods=rts,batch"}).status, 0);
  const nlohmann::json summary = Summary();
  EXPECT_THAT(summary["program"], HasSubstr("hindsight"));
  ASSERT_THAT(summary["methods"], SizeIs(2));
  for (const std::string method : {"rts", "batch"}) {
    const nlohmann::json& entry = summary["methods"][method];
    EXPECT_GT(entry["seconds"].get<double>(), 0.0);
    EXPECT_GT(entry["peak_rss_mb"].get<double>(), 1.0);
    EXPECT_TRUE(entry["converged"].get<bool>());
    EXPECT_THAT(entry["error"]["position_rms_m"], SizeIs(3));
    EXPECT_GT(entry["error"]["horizontal_rms_m"].get<double>(), 0.0);
    EXPECT_LT(entry["error"]["horizontal_rms_m"].get<double>(), 1.0);
    EXPECT_GT(entry["nees"]["position"].get<double>(), 0.0);
    EXPECT_FALSE(entry["residuals"].empty());
  }
}

TEST_F(RunCommandTest, AGivenValueThatTheDataContradictEndsWithThree) {
  const Outcome right = recording_.Run({"--out=right", "--methods=ekf,batch"});
  EXPECT_EQ(right.status, 0) << right.out;
  // 65 deg is right.
  recording_.Replace("config.yaml", "alignment: auto\ninitial:\n",
                     "alignment: given\ninitial:\n"
                     "  attitude: [0 deg, 0 deg, 95 deg]\n"
                     "  attitude_sigma: [1 deg, 1 deg, 3 deg]\n");
  const Outcome outcome = recording_.Run({"--out=out", "--methods=batch"});
  EXPECT_EQ(outcome.status, 3) << outcome.out;
  const std::vector<std::string> lines = Lines(outcome.out);
  EXPECT_THAT(lines.back(), StartsWith("batch is doubtful: attitude[down] "));
  EXPECT_THAT(lines, Contains(AllOf(StartsWith("batch is doubtful: attitude"),
                                    HasSubstr("; likely: "),
                                    HasSubstr("initial.attitude_sigma"))));
  const nlohmann::json summary = Summary();
  EXPECT_EQ(summary["best"], "batch");
  EXPECT_EQ(summary["grade"], "doubtful");
  const nlohmann::json& evidence = summary["methods"]["batch"]["evidence"];
  ASSERT_FALSE(evidence.empty());
  EXPECT_EQ(evidence[0]["rule"], "given_values");
  EXPECT_GT(evidence[0]["value"].get<double>(),
            evidence[0]["limit"].get<double>());
}

TEST_F(RunCommandTest, StatusAndLastLineAreThoseOfTheBestMethod) {
  const Outcome outcome =
      recording_.Run({"--out=out", "--methods=gated_ekf", "--without=speed",
                      "--inject=position:step=60m,from=25s"});
  EXPECT_EQ(outcome.status, 1) << outcome.out;
  EXPECT_THAT(Lines(outcome.out).back(),
              StartsWith("gated_ekf is not usable: the gate refused"));
  EXPECT_EQ(Summary()["grade"], "not usable");
}

TEST_F(RunCommandTest, OutputIsAtTheRateAndTimesAskedFor) {
  WriteFile(recording_.root() / "times.txt", "# poses\n10.125\n20.0625\n");
  ASSERT_EQ(recording_
                .Run({"--out=out", "--methods=rts", "--from=5", "--to=25",
                      "--rate=20", "--at=times.txt"})
                .status,
            0);
  const std::vector<std::string> rows = Rows(Result("rts.csv"));
  ASSERT_THAT(rows, SizeIs(401));
  EXPECT_DOUBLE_EQ(Field(rows.front(), 0), 5.0);
  EXPECT_DOUBLE_EQ(Field(rows[1], 0), 5.05);
  EXPECT_DOUBLE_EQ(Field(rows.back(), 0), 25.0);
  const std::vector<std::string> poses = Rows(Result("rts.at.csv"));
  ASSERT_THAT(poses, SizeIs(2));
  EXPECT_DOUBLE_EQ(Field(poses[0], 0), 10.125);
  EXPECT_DOUBLE_EQ(Field(poses[1], 0), 20.0625);
}

TEST_F(RunCommandTest, EveryResultSaysWhatItsTimesCountFrom) {
  recording_.Replace("config.yaml", "name: short\n",
                     "name: short\nepoch: 2025-07-08 19:34:21.5 GPST\n");
  WriteFile(recording_.root() / "times.txt", "10.125\n");
  ASSERT_EQ(recording_.Run({"--out=out", "--methods=ekf,imm", "--at=times.txt"})
                .status,
            0);
  int count = 0;
  for (const std::string& name : Names(recording_.root() / "out")) {
    if (!name.ends_with(".csv")) continue;
    ++count;
    bool said = false;
    for (const std::string& line : Lines(ReadFile(Result(name)))) {
      if (!line.starts_with('#')) break;
      said = said || line ==
                         "# epoch: t = 0 is GPS week 2374 second "
                         "243261.500000000, 2025-07-08T19:34:03.500Z";
    }
    EXPECT_TRUE(said) << name;
  }
  // Solution, --at, truth, errors and body motion of two methods, the modes of
  // one, residuals, fixes.
  EXPECT_EQ(count, 13);
  EXPECT_EQ(Summary()["epoch"]["gps_week"], 2374);
  EXPECT_EQ(Summary()["epoch"]["gps_second"], 243261.5);
}

TEST_F(RunCommandTest, PointMovesTheOutputByTheLeverArm) {
  ASSERT_EQ(recording_.Run({"--out=out", "--methods=rts"}).status, 0);
  ASSERT_EQ(
      recording_.Run({"--out=moved", "--methods=rts", "--point", "0,0,-1.5"})
          .status,
      0);
  const std::string at_imu = Rows(Result("rts.csv")).front();
  const std::string moved =
      Rows(recording_.root() / "moved" / "rts.csv").front();
  // The vehicle is level to a fraction of a degree at the start.
  EXPECT_NEAR(Field(moved, 3) - Field(at_imu, 3), 1.5, 1e-3);
}

TEST_F(RunCommandTest, WithheldFixesAreReportedAsOutages) {
  ASSERT_EQ(recording_
                .Run({"--out=out", "--methods=batch",
                      "--withhold=position:every=20s,length=5s,from=10s"})
                .status,
            0);
  const nlohmann::json withheld = Summary()["methods"]["batch"]["withheld"];
  // Starts at 10 s and 30 s; one at 50 s would be cut by the end at 50 s.
  EXPECT_THAT(withheld["outages"], SizeIs(2));
  EXPECT_GE(withheld["horizontal_max_m"].get<double>(),
            withheld["horizontal_rms_m"].get<double>());
  const std::string residuals = ReadFile(Result("residuals.csv"));
  EXPECT_THAT(residuals, HasSubstr(",withheld\n"));
}

TEST_F(RunCommandTest, ProgressForProgramsIsJsonLines) {
  const Outcome outcome =
      recording_.Run({"--out=out", "--methods=batch", "--progress=json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::vector<std::string> lines = Lines(outcome.err);
  ASSERT_FALSE(lines.empty());
  for (const std::string& line : lines) {
    const nlohmann::json object = nlohmann::json::parse(line);
    EXPECT_TRUE(object["stage"].is_string());
    EXPECT_GE(object["fraction"].get<double>(), 0.0);
    EXPECT_LE(object["fraction"].get<double>(), 1.0);
  }
  const nlohmann::json last = nlohmann::json::parse(lines.back());
  EXPECT_EQ(last["stage"], "done");
  EXPECT_EQ(last["fraction"], 1.0);
  EXPECT_EQ(last["seconds_left"], 0.0);
  EXPECT_EQ(last["run_fraction"], 1.0);
  EXPECT_EQ(last["run_seconds_left"], 0.0);
  double before = 0.0;
  for (const std::string& line : lines) {
    const double fraction = nlohmann::json::parse(line)["run_fraction"];
    EXPECT_GE(fraction, before);
    before = fraction;
  }
}

TEST_F(RunCommandTest, ExistingFolderIsReplacedOnlyByForce) {
  ASSERT_EQ(recording_.Run({"--out=out", "--methods=rts"}).status, 0);
  const Outcome refused = recording_.Run({"--out=out", "--methods=ekf"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("out"), HasSubstr("--force")));
  EXPECT_THAT(Names(recording_.root() / "out"), Contains("rts.csv"));
  ASSERT_EQ(recording_.Run({"--out=out/", "--methods=ekf", "--force"}).status,
            0);
  EXPECT_THAT(Names(recording_.root() / "out"), Contains("ekf.csv"));
  EXPECT_THAT(Names(recording_.root() / "out"),
              ::testing::Not(Contains("rts.csv")));
  EXPECT_THAT(Names(recording_.root()), UnorderedElementsAre("data", "out"));
}

TEST_F(RunCommandTest, WhatPoliciesDidIsCountedInTheReport) {
  recording_.Replace("config.yaml", "max_gap: 0.5 s",
                     "on_duplicate: drop_first\n  allow_truncated_tail: true");
  recording_.Edit("imu.csv", [](std::vector<std::string>* lines) {
    lines->insert(lines->begin() + 300, (*lines)[299]);
  });
  std::string text = ReadFile(recording_.file("imu.csv"));
  text.resize(text.size() - 40);
  WriteFile(recording_.file("imu.csv"), text);
  const Outcome outcome = recording_.Run({"--out=out", "--methods=rts"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json policies = Summary()["policies"];
  ASSERT_THAT(policies, SizeIs(2));
  for (const nlohmann::json& policy : policies) {
    EXPECT_EQ(policy["stream"], "imu");
    EXPECT_EQ(policy["count"], 1);
    EXPECT_THAT(outcome.out,
                HasSubstr("note: imu: " + policy["action"].get<std::string>()));
  }
}

TEST_F(RunCommandTest, NoAnswerEndsWithOneAndLeavesNothing) {
  // Velocities alone tell no place.
  recording_.Edit("config.yaml", [](std::vector<std::string>* lines) {
    const auto begin = std::find(lines->begin(), lines->end(), "  gnss:");
    lines->erase(begin, std::find(begin, lines->end(), "  speed:"));
  });
  const Outcome outcome = recording_.Run({"--out=out"});
  EXPECT_EQ(outcome.status, 1);
  ASSERT_THAT(Lines(outcome.err), SizeIs(1)) << outcome.err;
  EXPECT_THAT(outcome.err,
              StartsWith("hindsight: error: data/config.yaml: no initial "
                         "position: expected initial.position, "));
  EXPECT_THAT(Names(recording_.root()), ElementsAre("data"));
}

TEST_F(RunCommandTest, WeightsOfRejectedAndDownWeightedMeasurementsAreTold) {
  const auto with = [this](const std::string& line) {
    recording_.Replace("config.yaml", "    file: gnss.csv\n",
                       "    file: gnss.csv\n" + line);
    return recording_.Run({"--out=out", "--force", "--methods=ekf,rts",
                           "--log=info",
                           "--inject=position:pulse=8m,from=30s,to=34s"});
  };
  Outcome outcome = with("    noise: {model: mixture}\n");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  int down = 0;
  for (const std::string& line : Lines(ReadFile(Result("residuals.csv")))) {
    if (line.find(",gnss,0,") == line.npos) continue;
    EXPECT_TRUE(line.ends_with(",used")) << line;
    if (line.starts_with("ekf,") && Field(line, 7) < 0.01) ++down;
  }
  EXPECT_EQ(down, 4);
  int logged = 0;
  for (const std::string& line : Lines(outcome.err)) {
    if (line.find(" ekf: gnss at 3") == line.npos) continue;
    EXPECT_THAT(line, HasSubstr("down-weighted"));
    ++logged;
  }
  EXPECT_EQ(logged, 4);

  recording_.Replace("config.yaml", "    noise: {model: mixture}\n", "");
  outcome = with("    gate: 99.99 %\n");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  int rejected = 0;
  for (const std::string& line : Lines(ReadFile(Result("residuals.csv")))) {
    if (!line.ends_with(",rejected")) continue;
    EXPECT_EQ(Field(line, 7), 0.0) << line;
    ++rejected;
  }
  EXPECT_EQ(rejected, 2 * 4 * 3);
}

TEST_F(RunCommandTest, GateThatRefusesMostIsNotUsableAndTheTruthIsHeard) {
  const Outcome outcome =
      recording_.Run({"--out=out", "--methods=gated_ekf,ekf", "--without=speed",
                      "--inject=position:step=60m,from=25s"});
  EXPECT_THAT(outcome.out, HasSubstr("gated_ekf is not usable: the gate "
                                     "refused 26 of 51 measurements of gnss"));
  EXPECT_THAT(outcome.out,
              HasSubstr("\nekf: its covariances are not credible against the "
                        "truth: mean NEES of position "));
  EXPECT_THAT(outcome.out,
              Not(HasSubstr("\ngated_ekf: its covariances are not")));
}

TEST_F(RunCommandTest, FlagsThatDoNotFitTheRecordingEndWithTwo) {
  WriteFile(recording_.root() / "times.txt", "10\n70\n");
  WriteFile(recording_.root() / "order.txt", "10\n9\n");
  const std::vector<std::pair<std::string, std::string>> flags = {
      {"--withhold=gps:every=9s,length=3s", "'gps'"},
      {"--at=times.txt", "t = 70.000000 s"},
      {"--at=order.txt", "order.txt:2:"},
      {"--at=absent.txt", "absent.txt"},
      {"--rate=1e7", "IMU's 100 Hz"},
      {"--from=1000", "1000"}};
  const std::vector<std::string> before = Names(recording_.root());
  for (const auto& [flag, expected] : flags) {
    const Outcome outcome = recording_.Run({"--out=out", flag});
    EXPECT_EQ(outcome.status, 2) << flag;
    ASSERT_THAT(Lines(outcome.err), SizeIs(1)) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(expected));
    EXPECT_EQ(Names(recording_.root()), before);
  }
}

TEST_F(RunCommandTest, InjectedErrorsAreMarkedInEveryOutput) {
  const Outcome outcome = recording_.Run(
      {"--out=out", "--methods=gated_ekf,imm,imm_smoother,robust_batch",
       "--inject=position:step=12m,from=30s,to=40s", "--export=kml,tum,nav"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string mark =
      "injected on purpose: position: step of 12 m north, east from 30 s to 40 "
      "s";
  EXPECT_THAT(outcome.out, HasSubstr(mark));
  const std::vector<std::string> names = Names(recording_.root() / "out");
  EXPECT_GT(names.size(), 20u);
  for (std::string name : names) {
    if (name == "manifest.json") continue;  // names of files alone
    if (name.ends_with(".nav")) name += ".txt";
    EXPECT_THAT(ReadFile(Result(name)), HasSubstr(mark)) << name;
  }
  for (const char* name :
       {"imm.modes.csv", "imm_smoother.modes.csv", "robust_batch.modes.csv"}) {
    const std::vector<std::string> rows = Rows(Result(name));
    ASSERT_FALSE(rows.empty()) << name;
    double total = Field(rows[0], 1) + Field(rows[0], 2);
    if (std::count(rows[0].begin(), rows[0].end(), ',') > 2) {
      total += Field(rows[0], 3) + Field(rows[0], 4);
    }
    EXPECT_NEAR(total, 1.0, 1e-4) << name;
  }
  // Every one of the ten fixes is named with a weight of nearly nothing.
  int down = 0;
  for (const std::string& line : Lines(ReadFile(Result("residuals.csv")))) {
    if (!line.starts_with("imm_smoother,")) continue;
    if (Field(line, 3) == 0.0 && Field(line, 7) < 0.1) ++down;
  }
  EXPECT_GE(down, 10);
}

TEST_F(RunCommandTest, LogsEveryMeasurementThatLostHalfOfItsWeight) {
  const Outcome outcome =
      recording_.Run({"--out=out", "--methods=robust_batch", "--log=info",
                      "--inject=position:step=12m,from=30s,to=40s"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  int listed = 0;
  for (const std::string& line : Lines(outcome.err)) {
    if (line.find("robust_batch: gnss at 3") == line.npos) continue;
    EXPECT_THAT(line, HasSubstr("residual"));
    EXPECT_THAT(line, HasSubstr("weight"));
    ++listed;
  }
  EXPECT_EQ(listed, 10);
}

TEST_F(RunCommandTest, RefusesAnInjectionThatMakesNoSense) {
  for (const std::string text : {"position",
                                 "position:step=12",
                                 "position:step=1m,ramp=1m",
                                 "position:bend=1m",
                                 "position:pulse=1m",
                                 "position:step=1m,axes=x",
                                 "position:spikes=1m,share=200%",
                                 "position:step=0m",
                                 "position:step=1kg",
                                 "position:step=1m,share=10%",
                                 "position:step=1m,tau=5s",
                                 "position:spikes=1m,tau=5s",
                                 "position:multipath=1m,share=5%",
                                 "position:step=1m,from=1s,from=2s",
                                 "position:step=1m,axes=nn",
                                 "position:multipath=-1m",
                                 "position:spikes=-1m",
                                 "position:step=1m,from=20s,to=10s",
                                 "position:ramp=1m,to=10s",
                                 "position:step=1m;"}) {
    const Outcome outcome = recording_.Run({"--out=out", "--inject=" + text});
    EXPECT_EQ(outcome.status, 2) << text;
    EXPECT_THAT(outcome.err, HasSubstr("--inject=" + text + ": ")) << text;
    EXPECT_THAT(Lines(outcome.err), SizeIs(1)) << outcome.err;
  }
}

TEST_F(RunCommandTest, RefusesAnInjectionThatDoesNotFitTheRecording) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"height:step=1m", "name of such a stream: gnss, speed"},
      {"position:step=1m/s", "expected a size in m"},
      {"speed:step=10m", "expected a size in m/s"},
      {"gnss:step=1m,from=30s", "from 5 s to 20 s"},
      {"gnss:step=1m,from=12s,to=15s", "withheld"}};
  for (const auto& [text, expected] : cases) {
    const Outcome outcome =
        recording_.Run({"--out=out", "--inject=" + text, "--from=5", "--to=20",
                        "--withhold=position:every=20s,length=5s,from=11s"});
    EXPECT_EQ(outcome.status, 2) << text;
    EXPECT_THAT(Lines(outcome.err), SizeIs(1)) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("--inject: ")) << text;
    EXPECT_THAT(outcome.err, HasSubstr(expected)) << text;
  }
  const Outcome outcome = recording_.Run({"--out=out", "--seed=5"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--seed goes with --inject"));
}

TEST_F(RunCommandTest, OutagesAreJudgedByThePositionsBeforeInjection) {
  const auto rms = [&](const std::vector<std::string>& flags) {
    std::vector<std::string> all = {
        "--out=out", "--force", "--methods=ekf",
        "--withhold=position:every=20s,length=5s,from=10s"};
    all.insert(all.end(), flags.begin(), flags.end());
    EXPECT_NE(recording_.Run(all).status, 2);
    return Summary()["methods"]["ekf"]["withheld"]["horizontal_rms_m"]
        .get<double>();
  };
  // The fixes from 30 s to 34 s are withheld. That at 35 s is not, but a
  // forward filter knows nothing of it before.
  const double clean = rms({});
  EXPECT_EQ(rms({"--inject=position:pulse=100m,from=30s,to=36s"}), clean);
  EXPECT_THAT(ReadFile(Result("summary.json")), HasSubstr("(5 withheld"));
  EXPECT_NE(rms({"--inject=position:pulse=1m,from=29s,to=30s"}), clean);
}

TEST_F(RunCommandTest, CleanPositionsAreTruthWithTheClockThatIsEstimated) {
  recording_.Edit("config.yaml", [](std::vector<std::string>* lines) {
    const auto begin = std::find_if(
        lines->begin(), lines->end(),
        [](const std::string& line) { return line.starts_with("truth:"); });
    lines->erase(begin, begin + 2);
  });
  const std::vector<std::string> flags = {
      "--out=out", "--force", "--methods=batch",
      "--inject=position:step=0.01m,from=30s;gnss:pulse=0.01m,from=5s,to=9s"};
  const auto action = [&] {
    return Summary()["policies"][0]["action"].get<std::string>();
  };
  const auto rms = [&] {
    return Summary()["methods"]["batch"]["error"]["horizontal_rms_m"]
        .get<double>();
  };
  ASSERT_NE(recording_.Run(flags).status, 2);
  EXPECT_EQ(action(), "positions before injection taken as truth");
  const double with_equal_clocks = rms();
  const std::string resolved = ReadFile(Result("config.resolved.yaml"));
  EXPECT_LT(resolved.find("step of 0.01 m"), resolved.find("pulse of 0.01 m"));
  EXPECT_NE(resolved.find("pulse of 0.01 m"), resolved.npos);
  // Half a second off is several metres.
  recording_.Replace("config.yaml", "  gnss:\n",
                     "  gnss:\n    time_offset: 0.5 s\n"
                     "    estimate: {time_offset: 1 s}\n");
  ASSERT_NE(recording_.Run(flags).status, 2);
  EXPECT_THAT(action(), HasSubstr("that each method estimates"));
  EXPECT_NEAR(rms(), with_equal_clocks, 0.1);
}

TEST_F(RunCommandTest, TellsWhatIsWithheldAndTheStartWithItsSigmas) {
  const Outcome outcome =
      recording_.Run({"--out=out", "--methods=ekf",
                      "--withhold=position:every=20s,length=5s,from=10s"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("withheld: gnss: 2 outages, 10 "
                                     "measurements: 10.0 to 15.0 s, 30.0 to "
                                     "35.0 s\n"));
  const std::string resolved = ReadFile(Result("config.resolved.yaml"));
  EXPECT_THAT(resolved, HasSubstr("\n#   biases    sigma of gyros "));
  EXPECT_THAT(resolved, HasSubstr("\n#   velocity "));
  EXPECT_EQ(Hindsight({"run", "out/config.resolved.yaml", "--out=again",
                       "--methods=ekf"},
                      recording_.root())
                .status,
            0);
}

TEST_F(RunCommandTest, AResolvedConfigurationRunsToTheSameBytes) {
  const std::string plain = ReadFile(recording_.file("config.yaml"));
  for (const std::string noise :
       {"{model: white}", "{model: gauss_markov, sigma: 2 m, tau: 30 s}",
        "{model: mixture, outliers: 5 %, ratio: 20}"}) {
    SCOPED_TRACE(noise);
    WriteFile(recording_.file("config.yaml"), plain);
    recording_.Replace("config.yaml", "  gnss:\n",
                       "  gnss:\n    noise: " + noise + "\n");
    const Outcome first =
        recording_.Run({"--out=out", "--methods=batch", "--force"});
    ASSERT_NE(first.status, 2) << first.err;
    const Outcome again =
        Hindsight({"run", "out/config.resolved.yaml", "--out=again",
                   "--methods=batch", "--force"},
                  recording_.root());
    ASSERT_EQ(again.status, first.status) << again.err;
    for (const std::string file :
         {"batch.csv", "residuals.csv", "config.resolved.yaml"}) {
      EXPECT_EQ(ReadFile(Result(file)),
                ReadFile(recording_.root() / "again" / file))
          << file;
    }
  }
}

/// A lone receiver that errs by 1 m for half a minute: `batch` is wrong and finds nothing
/// odd, the search says that it errs or does not.
TEST(RunCommand, IsNotUsableBesideASearchThatDoubtsIt) {
  const TemporaryFolder folder;
  ASSERT_EQ(Hindsight({"simulate", "test_car", "--seed=340", "--duration=30",
                       "--out=drive", "--quiet"},
                      folder.path())
                .status,
            0);
  const auto run = [&folder](const std::string& methods) {
    return Hindsight(
               {"run", "drive/config.yaml", "--methods=" + methods,
                "--without=odometer", "--seed=340", "--out=out", "--force",
                "--inject=gnss:multipath=1m,from=0s,to=2000s,tau=50s,axes=ned"},
               folder.path())
        .status;
  };
  EXPECT_EQ(run("batch"), 0);
  EXPECT_EQ(run("batch,robust_batch"), 3);
  const nlohmann::json batch = nlohmann::json::parse(
      ReadFile(folder.path() / "out/summary.json"))["methods"]["batch"];
  EXPECT_THAT(batch["verdict"].get<std::string>(),
              StartsWith("doubtful: robust_batch: "));
  EXPECT_THAT(batch["nees"]["position"].get<double>(), Gt(30.0));
}

/// Slow errors of a camera, which the search finds and every other method takes for what
/// its noise leaves: `batch` is wrong, in whichever order the two are asked for.
TEST(RunCommand, IsTooSureBesideASearchThatFindsSlowErrors) {
  const TemporaryFolder folder;
  ASSERT_EQ(Hindsight({"simulate", "test_hand", "--seed=661", "--duration=120",
                       "--out=hand", "--quiet"},
                      folder.path())
                .status,
            0);
  for (const std::string methods : {"batch,robust_batch", "robust_batch,rts"}) {
    EXPECT_EQ(
        Hindsight({"run", "hand/config.yaml", "--methods=" + methods,
                   "--seed=661", "--out=out", "--force",
                   "--inject=camera:multipath=0.04m,from=0s,to=241s,tau=60s"},
                  folder.path())
            .status,
        0);
    const nlohmann::json summary =
        nlohmann::json::parse(ReadFile(folder.path() / "out/summary.json"));
    EXPECT_EQ(summary["best"], "robust_batch") << methods;
    const std::string other = methods[0] == 'b' ? "batch" : "rts";
    const nlohmann::json& plain = summary["methods"][other];
    EXPECT_EQ(plain["grade"], "doubtful");
    EXPECT_THAT(plain["verdict"].get<std::string>(),
                HasSubstr("by the errors of sensors that robust_batch finds or "
                          "cannot rule out, position["));
    EXPECT_THAT(plain["nees"]["position"].get<double>(), Gt(30.0)) << other;
  }
}

}  // namespace
}  // namespace hindsight
