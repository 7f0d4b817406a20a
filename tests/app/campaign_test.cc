#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/command_line.h"
#include "app/faults.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSubsetOf;
using ::testing::SizeIs;
using ::testing::StartsWith;

/// Three recordings of a minute, each in a folder of `recordings`.
class CampaignCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directory(path("recordings"));
    for (const char* name : {"a", "b", "c"}) {
      const Outcome outcome =
          Hindsight({"simulate", "short_drive", "--duration=60",
                     "--out=recordings/" + std::string(name), "--quiet",
                     "--seed=" + std::to_string(name[0])},
                    folder_.path());
      ASSERT_EQ(outcome.status, 0) << outcome.err;
    }
  }

  fs::path path(const std::string& name) const { return folder_.path() / name; }

  /// `campaign words... --out=out`.
  Outcome Call(std::vector<std::string> words, const std::string& out = "out",
               const std::function<void()>& prepare = {}) {
    words.insert(words.begin(), "campaign");
    words.push_back("--out=" + out);
    return Hindsight(words, folder_.path(), prepare);
  }

  Outcome CallAll(const std::string& out, const std::string& workers = "2",
                  const std::function<void()>& prepare = {}) {
    return Call({"recordings/*", "--methods=ekf,rts", "--workers=" + workers},
                out, prepare);
  }

  /// Lines of campaign.csv without the last two columns, seconds and mb.
  std::vector<std::string> Table(const std::string& out = "out") const {
    std::vector<std::string> lines =
        Lines(ReadFile(path(out) / "campaign.csv"));
    for (std::string& line : lines) {
      for (int i = 0; i < 2; ++i) line.erase(line.rfind(','));
    }
    return lines;
  }

  /// Files of results by item and name, but the one that tells times.
  std::map<std::string, std::string> Results(const std::string& out) const {
    std::map<std::string, std::string> files;
    for (const auto& item : fs::directory_iterator(path(out) / "items")) {
      for (const auto& file : fs::directory_iterator(item.path() / "results")) {
        const std::string name = file.path().filename();
        if (name == "summary.json") continue;
        files[item.path().filename().string() + "/" + name] =
            ReadFile(file.path());
      }
    }
    return files;
  }

  /// Nothing that a worker leaves when it dies, but a dead claim on an item
  /// that has ended, which nobody looks at again.
  void ExpectClean(const std::string& out) const {
    for (const auto& item : fs::directory_iterator(path(out) / "items")) {
      EXPECT_THAT(Names(item.path()),
                  IsSubsetOf({"item.json", "log.txt", "results", "claim.1"}));
    }
  }

  TemporaryFolder folder_;
};

TEST_F(CampaignCommand, WorksThroughAListAndDoesNothingTwice) {
  ASSERT_EQ(CallAll("out").status, 0);
  ExpectClean("out");
  EXPECT_THAT(Table(), SizeIs(4));
  // A minute of three positions and three velocities a second.
  constexpr double kRows = 360.0;
  for (const char* name : {"a", "b", "c"}) {
    const nlohmann::json record =
        nlohmann::json::parse(ReadFile(path("out/items") / name / "item.json"));
    EXPECT_NEAR(record["nis"].get<double>(), 1.0, 4.0 * std::sqrt(2.0 / kRows));
  }
  const auto log = [&](const std::string& name) {
    return fs::last_write_time(path("out/items") / name / "log.txt");
  };
  std::map<std::string, fs::file_time_type> before;
  for (const char* name : {"a", "b", "c"}) before[name] = log(name);
  const Outcome again = Call({});
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_THAT(again.out, HasSubstr("3 items: "));
  // Times alone decide nothing, content does.
  WriteFile(path("recordings/a/gnss.csv"),
            ReadFile(path("recordings/a/gnss.csv")));
  WriteFile(path("recordings/b/gnss.csv"),
            ReadFile(path("recordings/b/gnss.csv")) + "# more\n");
  ASSERT_EQ(Call({}).status, 0);
  EXPECT_EQ(log("a"), before["a"]);
  EXPECT_NE(log("b"), before["b"]);
  EXPECT_EQ(log("c"), before["c"]);
  // Other flags are another key.
  ASSERT_EQ(Call({"recordings/*", "--methods=ekf"}).status, 0);
  EXPECT_NE(log("c"), before["c"]);
  EXPECT_FALSE(fs::exists(path("out/items/c/results/rts.csv")));
}

TEST_F(CampaignCommand, ABadItemIsOneRowAndIsTriedAgainOnRequest) {
  WriteFile(path("list.csv"),
            "name,config,methods,withhold\n"
            "good,recordings/a,ekf,\n"
            "held,recordings/b/config.yaml,rts,\"gnss:every=20s,length=5s\"\n"
            "gone,recordings/d,ekf,\n"
            "typo,recordings/c,efk,\n");
  const Outcome outcome = Call({"list.csv", "--report"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, HasSubstr("2 failed"));
  const std::vector<std::string> table = Table();
  ASSERT_THAT(table, SizeIs(5));
  EXPECT_THAT(table[1],
              AllOf(StartsWith("gone,failed,,"), HasSubstr("recordings/d")));
  EXPECT_THAT(table[2], AllOf(StartsWith("typo,failed,,"), HasSubstr("efk")));
  EXPECT_THAT(table[3], StartsWith("held,done,"));
  EXPECT_THAT(table[4], AllOf(StartsWith("good,done,"),
                              HasSubstr("items/good/results/report.html")));
  EXPECT_THAT(ReadFile(path("out/campaign.html")),
              AllOf(HasSubstr("href=\"items/good/results/report.html\""),
                    HasSubstr("href=\"items/gone/log.txt\"")));
  fs::rename(path("recordings/c"), path("recordings/d"));
  // Its configuration is there now, so that its key is another.
  EXPECT_EQ(Call({}).status, 1);
  EXPECT_THAT(Table()[1], StartsWith("typo,failed"));
  EXPECT_THAT(Join(Table()), HasSubstr("gone,done"));
  const fs::file_time_type before =
      fs::last_write_time(path("out/items/typo/log.txt"));
  EXPECT_EQ(Call({}).status, 1);
  EXPECT_EQ(fs::last_write_time(path("out/items/typo/log.txt")), before);
  EXPECT_EQ(Call({"--retry"}).status, 1);
  EXPECT_NE(fs::last_write_time(path("out/items/typo/log.txt")), before);
}

TEST_F(CampaignCommand, ManyWorkersAndManyCallsGiveTheSameBytes) {
  ASSERT_EQ(CallAll("one", "1").status, 0);
  ASSERT_EQ(CallAll("four", "4").status, 0);
  const auto words = [](const std::string& out) -> std::vector<std::string> {
    return {"campaign", "recordings/*", "--methods=ekf,rts", "--workers=1",
            "--out=" + out};
  };
  {
    Child a(words("shared"), folder_.path());
    Child b(words("shared"), folder_.path());
    EXPECT_EQ(a.Wait().status, 0);
    EXPECT_EQ(b.Wait().status, 0);
  }
  for (const char* other : {"four", "shared"}) {
    EXPECT_EQ(Table(other), Table("one"));
    EXPECT_EQ(Results(other), Results("one"));
    ExpectClean(other);
  }
}

TEST_F(CampaignCommand, LimitsHurtOneRow) {
  ASSERT_EQ(Hindsight({"simulate", "car_drive", "--out=recordings/long",
                       "--duration=900", "--quiet"},
                      folder_.path())
                .status,
            0);
  const auto expect_one = [&](const std::string& out, const Outcome& outcome,
                              const std::string& reason) {
    EXPECT_EQ(outcome.status, 1);
    EXPECT_THAT(Table(out)[1],
                AllOf(StartsWith("long,failed"), HasSubstr(reason)));
    EXPECT_THAT(Table(out)[2], StartsWith("a,done"));
  };
  const std::vector<std::string> both = {"recordings/a", "recordings/long",
                                         "--methods=ekf"};
  const auto with = [&](const std::string& flag) {
    std::vector<std::string> words = both;
    words.push_back(flag);
    return words;
  };
  if (CanInjectFaults()) {
    ASSERT_EQ(Call({"recordings/a", "--methods=ekf"}, "slow").status, 0);
    expect_one("slow",
               Call(with("--time-limit=2"), "slow",
                    WithFaults({{"", "fsync:1:hang"}, {"_ONLY", "run"}})),
               "over its time limit of 2 s");
  }
  expect_one("small", Call(with("--memory-limit=40"), "small"),
             "out of memory (limit 40 MB)");
  // As on a full disk: only the long one's files are too large.
  const auto limit_files = [] {
    const rlimit limit = {8 << 20, 8 << 20};
    setrlimit(RLIMIT_FSIZE, &limit);
  };
  expect_one(
      "full",
      Call({"recordings/a", "recordings/long", "--methods=ekf", "--rate=100"},
           "full", limit_files),
      "cannot be written");
}

TEST_F(CampaignCommand, ARecordingWithoutConfigurationIsLookedAt) {
  fs::remove(path("recordings/a/config.yaml"));
  fs::remove(path("recordings/a/manifest.json"));
  const std::vector<std::string> words = {"recordings/a", "--methods=ekf"};
  ASSERT_EQ(Call(words).status, 0);
  EXPECT_THAT(Table()[1],
              AllOf(StartsWith("a,done,"),
                    HasSubstr("," + path("recordings/a").string() + ",")));
  EXPECT_EQ(Call({"--collect"}).status, 0);
  // A file more in the folder is another recording.
  WriteFile(path("recordings/a/notes.txt"), "fine weather\n");
  EXPECT_THAT(Call({"--collect"}).out, HasSubstr("1 open"));
  const Outcome inside = Call(words, "recordings/a/out");
  EXPECT_EQ(inside.status, 2);
  EXPECT_THAT(inside.err, HasSubstr("lies in the recording"));
}

TEST_F(CampaignCommand, ConstantsOfAnEarlierResultDecideTheKey) {
  for (const char* name : {"first", "second"}) {
    const std::string seed = std::string(name) == "first" ? "1" : "2";
    ASSERT_EQ(
        Hindsight({"simulate", "short_drive", "--duration=60", "--seed=" + seed,
                   "--set=aiding.gnss.estimate={lever_arm: 1 m}",
                   "--out=" + std::string(name), "--quiet"},
                  folder_.path())
            .status,
        0);
  }
  ASSERT_EQ(
      Hindsight({"run", "first/config.yaml", "--methods=ekf", "--out=before"},
                folder_.path())
          .status,
      0);
  WriteFile(path("list.csv"), "config,methods,constants\nsecond,ekf,before\n");
  ASSERT_EQ(Call({"list.csv"}).status, 0);
  EXPECT_THAT(ReadFile(path("out/items/second/results/summary.json")),
              HasSubstr("constants_from"));
  EXPECT_EQ(Call({"--collect"}).status, 0);
  WriteFile(path("before/summary.json"),
            ReadFile(path("before/summary.json")) + "\n");
  EXPECT_THAT(Call({"--collect"}).out, HasSubstr("1 open"));
}

TEST_F(CampaignCommand, InterruptedGoesOn) {
  Child child({"campaign", "recordings/*", "--methods=ekf,rts,batch",
               "--workers=1", "--out=out"},
              folder_.path());
  while (!fs::exists(path("out/items/a/item.json"))) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  child.Signal(SIGTERM);
  const Outcome stopped = child.Wait();
  EXPECT_EQ(stopped.status, 130);
  EXPECT_THAT(stopped.err, HasSubstr("the same call goes on"));
  EXPECT_FALSE(fs::exists(path("out/items/c/item.json")));
  EXPECT_EQ(Call({}).status, 0);
  ExpectClean("out");
}

TEST_F(CampaignCommand, WhatCannotBeAListIsRefused) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{}, "needs a LIST"},
      {{"recordings/x*"}, "finds nothing that is or fits 'recordings/x*'"},
      {{"recordings/a", "--workers=9999"}, "--workers=9999"},
      {{"recordings/a", "--engine=slrum"}, "expected local or slurm"},
      {{"recordings/a", "--dry-run"}, "goes with --engine=slurm"},
      {{"recordings/a", "--time-limit=0"}, "--time-limit"},
      {{"recordings/a", "--force"}, "unknown flag --force"},
      {{"recordings/a", "recordings/a"}, "config.yaml is listed twice"},
      {{"names.csv"}, "two items of the name 'x' ("},
      {{"semicolons.csv"}, "semicolons.csv:1: expected commas"},
      {{"no_items.csv"}, "no_items.csv: expected a line with the names"},
      {{"columns.csv"}, "columns.csv:1: column 'methds' is no flag"},
      {{"empty.csv"}, "empty.csv:2: expected a configuration"}};
  WriteFile(path("columns.csv"), "config,methds\nrecordings/a,ekf\n");
  WriteFile(path("empty.csv"), "config,methods\n,ekf\n");
  WriteFile(path("names.csv"), "config,name\nrecordings/a,x\nrecordings/b,x\n");
  WriteFile(path("semicolons.csv"), "config;methods\nrecordings/a;ekf\n");
  WriteFile(path("no_items.csv"), "config,methods\n");
  for (const auto& [words, expected] : cases) {
    const Outcome outcome = Call(words);
    EXPECT_EQ(outcome.status, 2) << expected;
    EXPECT_THAT(outcome.err, HasSubstr(expected));
    EXPECT_FALSE(fs::exists(path("out"))) << expected;
  }
  EXPECT_EQ(Call({"recordings/a"}, "recordings").status, 2);
}

TEST_F(CampaignCommand, SlurmsScriptStartsWorkersOfTheFolder) {
  const Outcome outcome =
      Call({"recordings/*", "--methods=ekf", "--engine=slurm", "--dry-run",
            "--workers=2", "--memory-limit=500", "--sbatch=--partition=night"},
           "my out");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(StartsWith("#!/bin/bash\n#SBATCH "),
                    HasSubstr("#SBATCH --array=1-2\n"),
                    HasSubstr("#SBATCH --mem=600M\n"),
                    HasSubstr("#SBATCH --partition=night\n"),
                    HasSubstr("--out='" + path("my out").string() + "'"),
                    HasSubstr("--memory-limit=500")));
  EXPECT_THAT(Names(path("my out/items")), ElementsAre());
}

/// A worker is killed at one call to the system after the other; the next call
/// finds all as it should be.
class KilledCampaign : public CampaignCommand {
 protected:
  Outcome CallTwo(const std::string& out,
                  const std::function<void()>& prepare = {}) {
    return Call(
        {"recordings/a", "recordings/b", "--methods=ekf", "--workers=1"}, out,
        prepare);
  }

  /// Whether the fault came about.
  bool KillAndResume(const std::string& fault) {
    fs::remove_all(path("out"));
    const Outcome killed =
        CallTwo("out", WithFaults({{"", fault}, {"_ONLY", "campaign"}}));
    std::map<std::string, fs::file_time_type> done;
    for (const char* name : {"a", "b"}) {
      const fs::path results = path("out/items") / name / "results";
      if (fs::exists(results)) done[name] = fs::last_write_time(results);
    }
    const Outcome resumed = CallTwo("out");
    EXPECT_EQ(resumed.status, 0) << fault << resumed.err;
    EXPECT_EQ(Table("out"), Table("expected")) << fault;
    EXPECT_EQ(Results("out"), Results("expected")) << fault;
    ExpectClean("out");
    for (const auto& [name, time] : done) {
      EXPECT_EQ(fs::last_write_time(path("out/items") / name / "results"), time)
          << name << " was run twice, " << fault;
    }
    return killed.status == 128 + SIGKILL;
  }
};

TEST_F(KilledCampaign, LosesNothingAndDoesNothingTwice) {
  if (!CanInjectFaults()) GTEST_SKIP() << "not under a sanitizer";
  ASSERT_EQ(CallTwo("expected").status, 0);
  const bool all = std::getenv("HINDSIGHT_ALL_FAULTS") != nullptr;
  constexpr int kFewer = 8;  // of the steps, unless all are asked for
  int fired = 0;
  for (const char* call : {"open", "mkdir", "unlink", "rename", "renameat2",
                           "fsync", "flock", "rmdir"}) {
    bool goes_on = true;
    for (int n = 1; goes_on; n += all ? 1 : kFewer) {
      for (const char* when : {"before", "after"}) {
        const std::string fault =
            std::string(call) + ":" + std::to_string(n) + ":" + when;
        goes_on = KillAndResume(fault);
        if (!goes_on) break;
        ++fired;
        if (!all) break;
      }
    }
  }
  EXPECT_GT(fired, 5);
}

}  // namespace
}  // namespace hindsight
