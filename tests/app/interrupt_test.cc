#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cerrno>
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/faults.h"
#include "app/recording.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;
using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::UnorderedElementsAre;
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

/// A drive that takes a batch some seconds, shared by all.
class Interrupt : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    drive_ = new TemporaryFolder;
    ASSERT_EQ(Hindsight({"simulate", "car_drive", "--out=data", "--seed=1"},
                        drive_->path())
                  .status,
              0);
  }
  static void TearDownTestSuite() {
    delete drive_;
    drive_ = nullptr;
  }
  void TearDown() override {
    for (const std::string& name : Names(root())) {
      if (name != "data") fs::remove_all(root() / name);
    }
  }

  static const fs::path& root() { return drive_->path(); }

  static std::vector<std::string> Words(
      const std::vector<std::string>& further) {
    std::vector<std::string> words = {"run", "data/config.yaml", "--out=out",
                                      "--progress=json"};
    words.insert(words.end(), further.begin(), further.end());
    return words;
  }

  /// Sends the signal when the stage begins; the answer within a second is
  /// checked.
  static Outcome Stopped(const std::vector<std::string>& words,
                         const std::string& stage, int signal) {
    Child run(words, root());
    EXPECT_TRUE(run.AwaitStage(stage)) << run.Err();
    run.Signal(signal);
    const Clock::time_point sent = Clock::now();
    Outcome outcome = run.Wait();
    EXPECT_LT(Clock::now() - sent, milliseconds(1000)) << stage;
    return outcome;
  }

  static nlohmann::json Json(const fs::path& path) {
    return nlohmann::json::parse(ReadFile(path));
  }

  /// That the folder holds what ekf made, and says so.
  static void ExpectEkfAlone(const fs::path& folder) {
    EXPECT_THAT(Names(folder),
                ElementsAre("config.resolved.yaml", "ekf.csv", "ekf.errors.csv",
                            "ekf.motion.csv", "ekf.truth.csv", "manifest.json",
                            "summary.json"));
    const nlohmann::json summary = Json(folder / "summary.json");
    EXPECT_EQ(summary["complete"], false);
    EXPECT_EQ(summary["methods"].size(), 1u);
    EXPECT_TRUE(summary["methods"].contains("ekf"));
    const nlohmann::json manifest = Json(folder / "manifest.json");
    EXPECT_EQ(manifest["complete"], false);
    EXPECT_EQ(manifest["files"].size(), 6u);
  }

  static TemporaryFolder* drive_;
};

TemporaryFolder* Interrupt::drive_ = nullptr;

TEST_F(Interrupt, LeavesNothingBeforeTheFirstMethodIsDone) {
  for (const std::string stage : {"reading", "ekf", "batch"}) {
    const Outcome outcome =
        Stopped(Words({"--methods=batch", "--rate=100"}), stage, SIGINT);
    EXPECT_EQ(outcome.status, 130) << stage;
    EXPECT_EQ(Lines(outcome.err).back(),
              "hindsight: error: interrupted; nothing was finished, nothing is "
              "left");
    // The start may have been reported; no result may.
    EXPECT_THAT(outcome.out, Not(HasSubstr("usable")));
    EXPECT_THAT(outcome.out, Not(HasSubstr("results in")));
    EXPECT_THAT(Names(root()), ElementsAre("data"));
  }
}

TEST_F(Interrupt, LeavesFinishedMethodsWhateverTheSignal) {
  ASSERT_TRUE(HasResults(Hindsight(
      {"run", "data/config.yaml", "--out=whole", "--methods=ekf"}, root())));
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const Outcome outcome =
        Stopped(Words({"--methods=ekf,batch"}), "batch", signal);
    EXPECT_EQ(outcome.status, 130) << signal;
    EXPECT_THAT(Lines(outcome.err).back(), HasSubstr("complete: false"));
    EXPECT_THAT(Names(root()), UnorderedElementsAre("data", "whole", "out"));
    ExpectEkfAlone(root() / "out");
    EXPECT_EQ(ReadFile(root() / "out" / "ekf.csv"),
              ReadFile(root() / "whole" / "ekf.csv"));
    fs::remove_all(root() / "out");
  }
}

TEST_F(Interrupt, NeverReplacesCompleteResultsButIncompleteOnes) {
  const std::vector<std::string> words =
      Words({"--methods=ekf,batch", "--force"});
  ASSERT_TRUE(HasResults(Hindsight(
      {"run", "data/config.yaml", "--out=out", "--methods=rts"}, root())));
  const std::string complete = ReadFile(root() / "out" / "rts.csv");
  Outcome outcome = Stopped(words, "batch", SIGINT);
  EXPECT_EQ(outcome.status, 130);
  EXPECT_THAT(outcome.err, HasSubstr((root() / "out.1").string()));
  EXPECT_THAT(Names(root()), UnorderedElementsAre("data", "out", "out.1"));
  EXPECT_EQ(ReadFile(root() / "out" / "rts.csv"), complete);
  ExpectEkfAlone(root() / "out.1");

  fs::remove_all(root() / "out");
  fs::rename(root() / "out.1", root() / "out");
  outcome = Stopped(words, "batch", SIGTERM);
  EXPECT_EQ(outcome.status, 130);
  EXPECT_THAT(Names(root()), UnorderedElementsAre("data", "out"));
  ExpectEkfAlone(root() / "out");
  EXPECT_TRUE(HasResults(Hindsight(
      {"run", "data/config.yaml", "--out=out", "--methods=rts", "--force"},
      root())));
  EXPECT_EQ(Json(root() / "out" / "summary.json")["complete"], true);
}

TEST_F(Interrupt, IsIgnoredWhereItWas) {
  for (const int signal : {SIGHUP, SIGINT, SIGTERM}) {
    Child run(Words({"--methods=ekf,rts"}), root(),
              [signal] { std::signal(signal, SIG_IGN); });
    ASSERT_TRUE(run.AwaitStage("ekf"));
    run.Signal(signal);
    EXPECT_TRUE(HasResults(run.Wait())) << signal;
    EXPECT_EQ(Json(root() / "out" / "summary.json")["complete"], true);
    fs::remove_all(root() / "out");
  }
}

TEST_F(Interrupt, IsAnsweredWithinASecondAtAnyMoment) {
  const std::vector<std::vector<std::string>> commands = {
      Words({"--methods=ekf,rts,iterated,batch,robust_batch", "--rate=100",
             "--export=tum,kml,nav"}),
      {"simulate", "car_drive", "--out=out"},
      {"montecarlo", "calibration", "--runs=4", "--out=out"},
      {"montecarlo", "uuv_search", "--runs=2", "--out=out"},
      {"montecarlo", "vibration_attitude", "--runs=2", "--out=out"}};
  int stopped = 0;
  for (const std::vector<std::string>& words : commands) {
    for (const int delay : {3, 40, 110, 350, 900}) {
      Child run(words, root());
      std::this_thread::sleep_for(milliseconds(delay));
      run.Signal(SIGTERM);
      const Clock::time_point sent = Clock::now();
      const int status = run.Wait().status;
      EXPECT_LT(Clock::now() - sent, milliseconds(1000))
          << words[0] << " " << words[1] << " after " << delay << " ms";
      // A young process has not got as far as to catch signals, and an old one
      // may have ended.
      EXPECT_THAT(status, AnyOf(130, 128 + SIGTERM, 0, 3));
      if (status == 130) ++stopped;
      for (const std::string& name : Names(root())) {
        EXPECT_THAT(name, AnyOf("data", "out"));
      }
      fs::remove_all(root() / "out");
    }
  }
  EXPECT_GE(stopped, 10);
}

TEST_F(Interrupt, HalfARecordingIsNoRecording) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    Child run({"simulate", "car_drive", "--out=out"}, root());
    while (Names(root()).size() < 2) {
      std::this_thread::sleep_for(milliseconds(1));
    }
    std::this_thread::sleep_for(milliseconds(100));
    run.Signal(signal);
    const Clock::time_point sent = Clock::now();
    const Outcome outcome = run.Wait();
    EXPECT_LT(Clock::now() - sent, milliseconds(1000));
    EXPECT_EQ(outcome.status, 130);
    EXPECT_EQ(outcome.err,
              "hindsight: error: interrupted; nothing was finished, nothing is "
              "left\n");
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(Names(root()), ElementsAre("data"));
  }
}

/// A comparison by seeds, of one cell, and one by settings.
std::vector<std::string> BySeeds(const std::string& runs) {
  return {"montecarlo",
          "in_flight_alignment",
          "--methods=ekf",
          "--error=quaternion",
          "--set=start_errors.tilt=10 deg",
          "--set=start_errors.heading=30 deg",
          "--set=aiding.velocity.rate=1 Hz",
          "--runs=" + runs,
          "--out=out",
          "--progress=json"};
}
std::vector<std::string> BySettings() {
  return {"montecarlo", "gps_jumps", "--set=errors=none|pulses|steps",
          "--runs=2",   "--out=out", "--progress=json"};
}

TEST_F(Interrupt, MonteCarloKeepsTheRunsThatAreFinished) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    Child run(BySeeds("100000"), root());
    ASSERT_TRUE(run.AwaitStage("runs")) << run.Err();
    std::this_thread::sleep_for(milliseconds(1500));
    run.Signal(signal);
    const Clock::time_point sent = Clock::now();
    const Outcome outcome = run.Wait();
    EXPECT_LT(Clock::now() - sent, milliseconds(1000));
    EXPECT_EQ(outcome.status, 130);
    EXPECT_THAT(Lines(outcome.err).back(),
                HasSubstr("montecarlo.json says complete: false"));
    EXPECT_THAT(Names(root()), UnorderedElementsAre("data", "out"));
    EXPECT_THAT(Names(root() / "out"),
                ElementsAre("cells.csv", "manifest.json", "montecarlo.json",
                            "runs.csv"));
    EXPECT_EQ(Json(root() / "out" / "manifest.json")["complete"], false);
    nlohmann::json part = Json(root() / "out" / "montecarlo.json");
    EXPECT_EQ(part["complete"], false);
    EXPECT_EQ(part["runs_asked"], 100000);
    const int runs = part["runs"];
    EXPECT_GE(runs, 2);
    const std::string cells = ReadFile(root() / "out" / "cells.csv");
    fs::remove_all(root() / "out");
    // What so many runs make.
    ASSERT_EQ(Hindsight(BySeeds(std::to_string(runs)), root()).status, 0);
    EXPECT_EQ(ReadFile(root() / "out" / "cells.csv"), cells);
    const nlohmann::json whole = Json(root() / "out" / "montecarlo.json");
    EXPECT_EQ(whole["complete"], true);
    EXPECT_EQ(whole["cells"], part["cells"]);
    fs::remove_all(root() / "out");
  }
}

TEST_F(Interrupt, MonteCarloKeepsNothingOfASingleRun) {
  Child run({"montecarlo", "calibration", "--threads=1", "--out=out"}, root());
  while (Names(root()).size() < 2) {
    std::this_thread::sleep_for(milliseconds(1));
  }
  run.Signal(SIGINT);
  const Outcome outcome = run.Wait();
  EXPECT_EQ(outcome.status, 130);
  EXPECT_THAT(outcome.err, HasSubstr("nothing was finished, nothing is left"));
  EXPECT_THAT(Names(root()), ElementsAre("data"));
}

TEST_F(Interrupt, MonteCarloKeepsTheSettingsThatAreFinished) {
  Child run(BySettings(), root());
  ASSERT_TRUE(run.AwaitStage("runs")) << run.Err();
  // More than the first of three is done when its share is passed.
  const auto first_is_done = [&run] {
    for (const std::string& line : Lines(run.Err())) {
      const auto json = nlohmann::json::parse(line, nullptr, false);
      if (json.is_object() && json.value("fraction", 0.0) > 0.4) return true;
    }
    return false;
  };
  while (!first_is_done()) std::this_thread::sleep_for(milliseconds(1));
  run.Signal(SIGTERM);
  EXPECT_EQ(run.Wait().status, 130);
  EXPECT_EQ(Json(root() / "out" / "montecarlo.json")["complete"], false);
  EXPECT_THAT(Names(root() / "out"),
              ElementsAre("cells.csv", "curves.csv", "manifest.json",
                          "montecarlo.json", "runs.csv"));
  for (const char* name : {"cells.csv", "curves.csv", "runs.csv"}) {
    const std::string lines = ReadFile(root() / "out" / name);
    EXPECT_THAT(lines, HasSubstr("none,rts,")) << name;
    EXPECT_THAT(lines, Not(HasSubstr("steps,"))) << name;
  }
}

TEST_F(Interrupt, TheSecondEndsAtOnce) {
  if (!CanInjectFaults()) GTEST_SKIP() << "no preloading under a sanitizer";
  // The first waits for a medium that does not answer: the third file that is
  // synced is the summary after ekf.
  Child run(Words({"--methods=ekf,batch"}), root(),
            WithFaults({{"", "fsync:8:hang"}}));
  ASSERT_TRUE(run.AwaitStage("ekf"));
  std::this_thread::sleep_for(milliseconds(1500));
  run.Signal(SIGINT);
  run.Signal(SIGINT);  // as of timeout(1), which signals process and group
  std::this_thread::sleep_for(milliseconds(200));
  run.Signal(SIGINT);
  const Clock::time_point sent = Clock::now();
  EXPECT_EQ(run.Wait().status, 130);
  EXPECT_LT(Clock::now() - sent, milliseconds(500));
}

/// A medium that ends: what was done stays.
class MediumThatEnds : public ::testing::Test {
 protected:
  nlohmann::json Summary() const {
    return nlohmann::json::parse(
        ReadFile(recording_.root() / "out" / "summary.json"));
  }
  Outcome Run(const std::vector<std::string>& flags,
              const std::function<void()>& prepare) const {
    std::vector<std::string> words = {"run", "data/config.yaml", "--out=out"};
    words.insert(words.end(), flags.begin(), flags.end());
    return Hindsight(words, recording_.root(), prepare);
  }
  Recording recording_;
};

TEST_F(MediumThatEnds, LimitOfFileSizeKeepsTheMethodsThatFit) {
  ASSERT_TRUE(HasResults(Run({"--methods=ekf,two_filter"}, {})));
  const auto size = [&](const std::string& name) {
    return fs::file_size(recording_.root() / "out" / name);
  };
  // A column more.
  const auto fits = size("ekf.truth.csv");
  ASSERT_LT(size("ekf.csv"), fits);
  ASSERT_LT(fits, size("two_filter.truth.csv"));
  ASSERT_LT(size("summary.json"), fits);
  for (const auto limit : {fits, fits - 1}) {
    fs::remove_all(recording_.root() / "out");
    const rlimit both = {limit, limit};
    const Outcome outcome = Run({"--methods=ekf,two_filter"},
                                [&] { setrlimit(RLIMIT_FSIZE, &both); });
    EXPECT_EQ(outcome.status, 4);
    EXPECT_THAT(outcome.err, HasSubstr("File too large"));
    if (limit == fits) {
      EXPECT_EQ(Summary()["complete"], false);
      EXPECT_THAT(Names(recording_.root() / "out"), Contains("ekf.csv"));
      EXPECT_THAT(Names(recording_.root() / "out"),
                  Not(Contains("two_filter.csv")));
    } else {
      EXPECT_THAT(outcome.err, HasSubstr("nothing is left"));
      EXPECT_THAT(Names(recording_.root()), ElementsAre("data"));
    }
  }
}

TEST_F(MediumThatEnds, FullDiskLeavesNoHalfRecordingAndFinishedRuns) {
  if (!CanInjectFaults()) GTEST_SKIP() << "no preloading under a sanitizer";
  const std::string full = std::to_string(ENOSPC);
  const fs::path root = recording_.root();
  const auto command = [&](const std::vector<std::string>& words,
                           const std::string& fault) {
    return Hindsight(words, root, WithFaults({{"", fault}}));
  };
  for (int at = 1; at <= 8; ++at) {
    const Outcome outcome =
        command({"simulate", "short_drive", "--out=out"},
                "write:" + std::to_string(at) + "+:" + full);
    EXPECT_EQ(outcome.status, 4) << at;
    EXPECT_THAT(outcome.err, HasSubstr("nothing is left"));
    EXPECT_THAT(outcome.err, HasSubstr((root / "out/").string()));
    EXPECT_THAT(outcome.err, Not(HasSubstr(".partial-")));
    EXPECT_THAT(outcome.err, HasSubstr("No space left"));
    EXPECT_THAT(Names(root), ElementsAre("data"));
  }
  int kept = 0;
  for (int at = 1; at <= 20; ++at) {
    // Room that comes free is room for what matters most.
    const Outcome outcome =
        command(BySeeds("2"), "write:" + std::to_string(at) + ":" + full);
    if (outcome.status == 0) break;
    EXPECT_EQ(outcome.status, 4) << outcome.err;
    EXPECT_THAT(Lines(outcome.err).back(), HasSubstr("complete: false"));
    EXPECT_THAT(outcome.err, Not(HasSubstr(".partial-")));
    EXPECT_THAT(Names(root / "out"),
                ElementsAre("cells.csv", "manifest.json", "montecarlo.json",
                            "runs.csv"));
    const nlohmann::json json =
        nlohmann::json::parse(ReadFile(root / "out" / "montecarlo.json"));
    EXPECT_EQ(json["complete"], false);
    EXPECT_EQ(json["runs"], 2);
    ++kept;
    fs::remove_all(root / "out");
  }
  EXPECT_GE(kept, 4);
  fs::remove_all(root / "out");
  const Outcome none = command(BySeeds("2"), "write:1+:" + full);
  EXPECT_EQ(none.status, 4);
  EXPECT_THAT(none.err, HasSubstr("nothing is left"));
  EXPECT_THAT(Names(root), ElementsAre("data"));
}

TEST_F(MediumThatEnds, FullDiskKeepsTheMethodsThatWereDone) {
  if (!CanInjectFaults()) GTEST_SKIP() << "no preloading under a sanitizer";
  const std::string full = std::to_string(ENOSPC);
  int kept = 0;
  int none = 0;
  // A method's files are a dozen calls and more, fewer where threads that
  // write them meet.
  constexpr int kStride = 2;
  for (int at = 1; at <= 36 * kStride; at += kStride) {
    const std::string fault = "write:" + std::to_string(at) + "+:" + full;
    const Outcome outcome =
        Run({"--methods=ekf,rts"}, WithFaults({{"", fault}}));
    if (HasResults(outcome)) break;
    EXPECT_EQ(outcome.status, 4) << fault;
    EXPECT_THAT(Lines(outcome.err).back(), HasSubstr("No space left"));
    EXPECT_THAT(outcome.err, Not(HasSubstr(".partial-")));
    if (fs::exists(recording_.root() / "out")) {
      ++kept;
      EXPECT_THAT(Lines(outcome.err).back(), HasSubstr("complete: false"));
      EXPECT_EQ(Summary()["complete"], false);
      EXPECT_TRUE(Summary()["methods"].contains("ekf"));
      EXPECT_THAT(Names(recording_.root() / "out"), Contains("ekf.csv"));
      fs::remove_all(recording_.root() / "out");
    } else {
      ++none;
      EXPECT_THAT(Lines(outcome.err).back(), HasSubstr("nothing is left"));
    }
    EXPECT_THAT(Names(recording_.root()), ElementsAre("data"));
  }
  EXPECT_GE(kept, 3);
  EXPECT_GE(none, 3);
}

}  // namespace
}  // namespace hindsight
