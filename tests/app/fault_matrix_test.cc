#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "app/faults.h"
#include "app/recording.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// All files of a folder; nothing if there is none.
using Content = std::map<std::string, std::string>;

Content ContentOf(const fs::path& folder) {
  Content content;
  if (!fs::is_directory(folder)) return content;
  for (const std::string& name : Names(folder)) {
    content[name] = ReadFile(folder / name);
  }
  return content;
}

/// What fails once, or where the process is killed.
struct Fault {
  std::string call;
  int at = 0;
  std::string action;
  std::string Text() const {
    return call + ":" + std::to_string(at) + ":" + action;
  }
};

/// Processor time and memory differ from run to run.
Json WithoutCosts(const std::string& summary) {
  Json json = Json::parse(summary);
  for (auto& [name, method] : json["methods"].items()) {
    method.erase("seconds");
    method.erase("peak_rss_mb");
  }
  return json;
}

class FaultMatrix : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!CanInjectFaults()) GTEST_SKIP() << "no preloading under a sanitizer";
    const fs::path scenario = folder_.path() / "scenario.yaml";
    WriteFile(scenario, kScenario);
    const Outcome made =
        Hindsight({"simulate", "scenario.yaml", "--out=data"}, folder_.path());
    ASSERT_EQ(made.status, 0) << made.err;
    data_ = ContentOf(folder_.path() / "data");
    old_ = Reference("old", {"--methods=ekf", "--rate=2"});
    new_ = Reference("new", kNew);
    ASSERT_GT(new_.size(), old_.size());
  }

  Content Reference(const std::string& name, std::vector<std::string> flags) {
    flags.insert(flags.begin(), {"run", "data/config.yaml", "--out=" + name});
    const Outcome outcome = Hindsight(flags, folder_.path());
    EXPECT_TRUE(HasResults(outcome)) << outcome.err;
    return ContentOf(folder_.path() / name);
  }

  fs::path work() const { return folder_.path() / "work"; }

  void Prepare(bool force) const {
    fs::remove_all(work());
    fs::create_directory(work());
    WriteFile(work() / "thesis.txt", "mine");
    if (force) fs::copy(folder_.path() / "old", work() / "out");
  }

  Outcome Run(bool force, std::map<std::string, std::string> faults) const {
    std::vector<std::string> words = {"run", "data/config.yaml",
                                      "--out=work/out"};
    words.insert(words.end(), kNew.begin(), kNew.end());
    if (force) words.emplace_back("--force");
    return Hindsight(words, folder_.path(), WithFaults(std::move(faults)));
  }

  /// How often a run without faults makes each call.
  std::map<std::string, int> Calls(bool force) const {
    Prepare(force);
    const fs::path log = folder_.path() / "log";
    fs::remove(log);
    EXPECT_TRUE(HasResults(Run(force, {{"_LOG", log.string()}})));
    std::map<std::string, int> calls;
    for (const std::string& call : Lines(ReadFile(log))) ++calls[call];
    return calls;
  }

  /// Files that are of the new results, byte for byte.
  bool IsPartOfNew(const Content& content) const {
    for (const auto& [name, text] : content) {
      if (!new_.contains(name)) return false;
      if (name == "summary.json" || name == "manifest.json") continue;
      if (new_.at(name) != text) return false;
    }
    return true;
  }

  /// "absent", "old", "new", "part" (which says so itself) or "mixed".
  std::string Kind(const fs::path& folder) const {
    const Content content = ContentOf(folder);
    if (content.empty()) return fs::exists(folder) ? "mixed" : "absent";
    if (content == old_) return "old";
    if (!IsPartOfNew(content) || !content.contains("summary.json") ||
        !content.contains("manifest.json")) {
      return "mixed";
    }
    const Json summary = WithoutCosts(content.at("summary.json"));
    const Json manifest = Json::parse(content.at("manifest.json"));
    if (manifest["files"].size() != content.size() - 1) return "mixed";
    if (summary["complete"] != manifest["complete"]) return "mixed";
    if (summary["complete"] == true) {
      return summary == WithoutCosts(new_.at("summary.json")) ? "new" : "mixed";
    }
    for (const auto& [name, method] : summary["methods"].items()) {
      if (!content.contains(name + ".csv")) return "mixed";
    }
    return summary["methods"].empty() ? "mixed" : "part";
  }

  /// The folders in which a killed run wrote, and the other names.
  std::vector<fs::path> Partial() const {
    std::vector<fs::path> found;
    for (const std::string& name : Names(work())) {
      if (name.starts_with(".out.partial-")) found.push_back(work() / name);
    }
    return found;
  }

  void Judge(bool force, const Outcome& outcome) const {
    const std::string kind = Kind(work() / "out");
    const bool killed = outcome.status == 128 + SIGKILL;
    std::multiset<std::string> partial;
    for (const fs::path& path : Partial()) partial.insert(Kind(path));
    EXPECT_NE(kind, "mixed");
    if (HasResults(outcome)) {
      EXPECT_EQ(kind, "new");
      EXPECT_TRUE(partial.empty());
    }
    if (force) {
      // Until the new results are in place the old ones are, under their name
      // but for a kill between two renames.
      EXPECT_TRUE(kind == "old" || kind == "new" ||
                  (killed && kind == "absent" && partial.contains("old")))
          << kind;
    } else {
      EXPECT_NE(kind, "old");
    }
    const std::string beside = Kind(work() / "out.1");
    EXPECT_TRUE(beside == "absent" || beside == "new" || beside == "part")
        << beside;
    if (!killed) {
      // What stays is told, and what is told stays.
      const bool tells_new =
          outcome.err.find("finished results are in") != std::string::npos;
      const bool tells_part =
          outcome.err.find("complete: false") != std::string::npos;
      EXPECT_EQ(tells_new, beside == "new");
      EXPECT_EQ(tells_part, beside == "part" || kind == "part");
      EXPECT_TRUE(partial.empty() ||
                  outcome.err.find("lost with the power") != std::string::npos);
    }
    EXPECT_EQ(ReadFile(work() / "thesis.txt"), "mine");
    EXPECT_EQ(ContentOf(folder_.path() / "data"), data_);
  }

  /// Every fault of every call, or with a `stride` some; the number that fired.
  void RunAll(bool force, const std::map<std::string, std::string>& further,
              int stride, int least) {
    const std::map<std::string, int> calls = [&] {
      Prepare(force);
      return Calls(force);
    }();
    const std::map<std::string, int> errors = {
        {"open", EMFILE}, {"close", EIO},    {"write", ENOSPC},
        {"fsync", EIO},   {"mmap", ENOMEM},  {"mkdir", ENOSPC},
        {"rename", EIO},  {"renameat2", EIO}};
    int planned = 0;
    int fired = 0;
    int next = 0;
    const fs::path log = folder_.path() / "log";
    for (const auto& [call, count] : calls) {
      for (int at = 1; at <= count; ++at) {
        for (const std::string& action :
             {std::to_string(errors.at(call)), std::string("before"),
              std::string("after")}) {
          if (next++ % stride != 0) continue;
          ++planned;
          const Fault fault = {call, at, action};
          SCOPED_TRACE(fault.Text() + (force ? " --force" : ""));
          Prepare(force);
          fs::remove(log);
          std::map<std::string, std::string> variables = further;
          variables[""] = fault.Text();
          variables["_LOG"] = log.string();
          const Outcome outcome = Run(force, variables);
          const std::vector<std::string> lines = Lines(ReadFile(log));
          fired +=
              static_cast<int>(std::count(lines.begin(), lines.end(), "fired"));
          Judge(force, outcome);
          if (HasFailure()) return;
        }
      }
    }
    // Which of two threads opens first is no matter, whether it opens is.
    EXPECT_GE(fired, planned - planned / 20);
    EXPECT_GE(fired, least);
    std::cout << fired << " faults of " << planned << " fired\n";
    RecordProperty("fired", fired);
  }

  /// HINDSIGHT_ALL_FAULTS=1 in the environment asks for the whole matrix.
  static int Stride(int stride) {
    return std::getenv("HINDSIGHT_ALL_FAULTS") != nullptr ? 1 : stride;
  }

  const std::vector<std::string> kNew = {"--methods=ekf,rts"};
  static constexpr const char* kScenario = R"(
name: tiny
start: {position: [48 deg, 11.5 deg, 500 m], heading: 65 deg}
segments:
  - {type: stop, duration: 3 s}
  - {type: accelerate, speed: 8 m/s, rate: 4 m/s^2}
  - {type: turn, angle: 90 deg, rate: 60 deg/s}
  - {type: straight, duration: 10 s}
duration: 8 s
imu:
  rate: 50 Hz
  noise: {gyro: 0.1 deg/sqrt(h), accel: 0.05 m/s/sqrt(h)}
  gyro_bias_sigma: 3 deg/h
  accel_bias_sigma: 1 mg
aiding:
  gnss: {type: position, rate: 2 Hz, sigma: [0.2 m, 0.2 m, 0.4 m]}
  speed: {type: velocity, rate: 2 Hz, sigma: 0.05 m/s}
stationary: {velocity_sigma: 0.01 m/s}
)";
  TemporaryFolder folder_;
  Content data_;
  Content old_;
  Content new_;
};

TEST_F(FaultMatrix, FreshFolder) { RunAll(false, {}, Stride(1), 60); }

TEST_F(FaultMatrix, ReplacedFolder) { RunAll(true, {}, Stride(1), 60); }

TEST_F(FaultMatrix, ReplacedFolderWithoutExchange) {
  RunAll(true, {{"_NO_EXCHANGE", "1"}}, Stride(3), 20);
}

TEST_F(FaultMatrix, RepeatedProcessIdsMixNothing) {
  for (int i = 0; i < 3; ++i) {
    Prepare(false);
    const Outcome killed = Hindsight(
        {"run", "data/config.yaml", "--out=work/out", "--methods=ekf",
         "--rate=2"},
        folder_.path(), WithFaults({{"_PID", "7"}, {"", "rename:3:before"}}));
    ASSERT_EQ(killed.status, 128 + SIGKILL);
    ASSERT_EQ(Partial().size(), 1u);
    const fs::path left = Partial().front();
    const Content before = ContentOf(left);
    const Outcome outcome = Run(false, {{"_PID", "7"}});
    EXPECT_TRUE(HasResults(outcome)) << outcome.err;
    EXPECT_EQ(Kind(work() / "out"), "new");
    EXPECT_NE(outcome.err.find(left.string() + " is left of a killed run"),
              std::string::npos)
        << outcome.err;
    EXPECT_EQ(ContentOf(left), before);
  }
}

TEST_F(FaultMatrix, OldPartialFoldersAreRemovedOnRequestAlone) {
  Prepare(false);
  ASSERT_EQ(Run(false, {{"", "rename:3:before"}}).status, 128 + SIGKILL);
  ASSERT_EQ(Partial().size(), 1u);
  // One whose run goes on.
  Child other({"run", "data/config.yaml", "--out=work/out", "--methods=ekf"},
              folder_.path(), WithFaults({{"", "fsync:2:hang"}}));
  for (int i = 0; i < 2000 && Partial().size() < 2; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ASSERT_EQ(Partial().size(), 2u);
  const Outcome outcome = Hindsight(
      {"run", "data/config.yaml", "--out=work/out", "--methods=ekf", "--clean"},
      folder_.path());
  EXPECT_TRUE(HasResults(outcome)) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(Partial().size(), 1u);
  other.Signal(SIGKILL);
  other.Wait();
}

TEST_F(FaultMatrix, TwoRunsAtOnceLoseNothing) {
  int beside = 0;
  for (int i = 0; i < 10; ++i) {
    Prepare(false);
    const std::vector<std::string> words = {"run", "data/config.yaml",
                                            "--out=work/out"};
    std::vector<std::string> second = words;
    second.insert(second.end(), kNew.begin(), kNew.end());
    std::vector<std::string> first = words;
    first.insert(first.end(), {"--methods=ekf", "--rate=2"});
    Child a(first, folder_.path());
    Child b(second, folder_.path());
    const Outcome of_a = a.Wait();
    const Outcome of_b = b.Wait();
    EXPECT_NE(HasResults(of_a), HasResults(of_b));
    // The slower one finds the folder at its start or at its end.
    const Outcome& late = HasResults(of_a) ? of_b : of_a;
    EXPECT_TRUE(late.status == 2 || late.status == 4) << late.err;
    EXPECT_TRUE(Partial().empty());
    if (late.status == 4) {
      ++beside;
      EXPECT_NE(late.err.find((work() / "out.1").string()), std::string::npos)
          << late.err;
      EXPECT_TRUE(fs::exists(work() / "out.1" / "ekf.csv"));
    }
    EXPECT_EQ(ContentOf(work() / "out").size(),
              HasResults(of_a) ? old_.size() : new_.size());
  }
  EXPECT_GE(beside, 1);
}

}  // namespace
}  // namespace hindsight
