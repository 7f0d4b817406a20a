#ifndef HINDSIGHT_TESTS_APP_FAULT_MATRIX_H_
#define HINDSIGHT_TESTS_APP_FAULT_MATRIX_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "app/faults.h"
#include "app/recording.h"

namespace hindsight {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// All files of a folder; nothing if there is none.
using Content = std::map<std::string, std::string>;

inline Content ContentOf(const fs::path& folder) {
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
inline Json WithoutCosts(const std::string& summary) {
  Json json = Json::parse(summary);
  for (auto& [name, method] : json["methods"].items()) {
    method.erase("seconds");
    method.erase("peak_rss_mb");
  }
  return json;
}

/// A run with two methods whose calls to the system fail or are its last, one
/// by one, and what it leaves of its folder and of others.
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

  /// The page tells processor times and its folder, which differ.
  static bool IsWholePage(const std::string& text) {
    return text.starts_with("<!DOCTYPE html>") && text.ends_with("</html>\n");
  }

  /// Files that are of the new results, byte for byte.
  bool IsPartOfNew(const Content& content) const {
    for (const auto& [name, text] : content) {
      if (!new_.contains(name)) return false;
      if (name == "summary.json" || name == "manifest.json") continue;
      if (name == "report.html") {
        if (!IsWholePage(text)) return false;
        continue;
      }
      if (new_.at(name) != text) return false;
    }
    return true;
  }

  static bool ListsAll(const Json& manifest, const Content& content) {
    const auto files = manifest["files"].get<std::set<std::string>>();
    for (const auto& [name, text] : content) {
      if (name != "manifest.json" && !files.contains(name)) return false;
    }
    return manifest["complete"] == false || files.size() == content.size() - 1;
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
    // One that was left lists what it holds, and what it never got to hold.
    if (!ListsAll(manifest, content)) return "mixed";
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
    // Of what cannot be removed it is said where it is.
    const bool tells_left =
        outcome.err.find(" is left in ") != std::string::npos ||
        outcome.err.find("which cannot be removed") != std::string::npos ||
        outcome.err.find("lost with the power") != std::string::npos;
    if (HasResults(outcome)) {
      EXPECT_EQ(kind, "new");
      EXPECT_TRUE(partial.empty() || tells_left) << outcome.err;
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
      EXPECT_TRUE(partial.empty() || tells_left) << outcome.err;
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
        {"open", EMFILE},  {"openat", EMFILE}, {"fopen", EMFILE},
        {"write", ENOSPC}, {"mmap", ENOMEM},   {"mkdir", ENOSPC},
        {"link", ENOSPC}};
    const auto error_of = [&](const std::string& call) {
      const auto listed = errors.find(call);
      return std::to_string(listed == errors.end() ? EIO : listed->second);
    };
    int planned = 0;
    int fired = 0;
    int next = 0;
    const fs::path log = folder_.path() / "log";
    for (const auto& [call, count] : calls) {
      for (int at = 1; at <= count; ++at) {
        for (const std::string& action :
             {error_of(call), std::string("before"), std::string("after")}) {
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

  const std::vector<std::string> kNew = {"--methods=ekf,rts", "--report"};
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

}  // namespace hindsight

#endif  // HINDSIGHT_TESTS_APP_FAULT_MATRIX_H_
