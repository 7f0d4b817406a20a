#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include "app/recording.h"

namespace hindsight {
namespace {

/// An environment variable set for as long as the object lives.
class ScopedVariable {
 public:
  ScopedVariable(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name)) before_ = old;
    setenv(name, value.c_str(), 1);
  }
  ~ScopedVariable() {
    if (before_) {
      setenv(name_, before_->c_str(), 1);
    } else {
      unsetenv(name_);
    }
  }
  ScopedVariable(const ScopedVariable&) = delete;
  ScopedVariable& operator=(const ScopedVariable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

/// What differs from run to run by nature: processor times, memory, and the
/// folder in which it was run.
std::string WithoutCosts(std::string text, const std::filesystem::path& root) {
  static const std::regex kCosts(
      "\"[a-z_]*(seconds|peak_rss_mb)\": [-+0-9.eE]+");
  text = std::regex_replace(text, kCosts, "");
  for (std::size_t at = 0;
       (at = text.find(root.string(), at)) != std::string::npos;) {
    text.erase(at, root.string().size());
  }
  return text;
}

/// All files of a result, by name.
std::map<std::string, std::string> RunIn(
    const std::filesystem::path& root, const std::string& out,
    const std::vector<std::string>& more = {}) {
  std::vector<std::string> words = {
      "run", "data/config.yaml", "--out=" + out, "--export=csv,npz,tum,kml,nav",
      "--methods=ekf,rts,two_filter,iterated,batch"};
  words.insert(words.end(), more.begin(), more.end());
  const Outcome outcome = Hindsight(words, root);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  std::map<std::string, std::string> files;
  for (const std::string& name : Names(root / out)) {
    files[name] = WithoutCosts(ReadFile(root / out / name), root);
  }
  return files;
}

void ExpectSameFiles(const std::map<std::string, std::string>& a,
                     const std::map<std::string, std::string>& b) {
  ASSERT_GE(a.size(), 8u);
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [name, text] : a) {
    ASSERT_TRUE(b.contains(name)) << name;
    EXPECT_TRUE(text == b.at(name)) << name << " differs";
  }
}

TEST(SameBytes, RunAfterRun) {
  const Recording recording;
  ExpectSameFiles(RunIn(recording.root(), "a"), RunIn(recording.root(), "b"));
}

/// Long enough that each loop which may be cut is cut.
TEST(SameBytes, ForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const Outcome made = Hindsight(
      {"simulate", "test_car", "--seed=7", "--out=data"}, folder.path());
  ASSERT_EQ(made.status, 0) << made.err;
  const auto alone = RunIn(folder.path(), "a", {"--threads=1"});
  ExpectSameFiles(alone, RunIn(folder.path(), "b", {"--threads=2"}));
  ExpectSameFiles(alone, RunIn(folder.path(), "c", {"--threads=7"}));
}

TEST(SameBytes, InAnotherFolderAndTimeZone) {
  const Recording recording;
  const auto here = RunIn(recording.root(), "a");
  const TemporaryFolder elsewhere;
  std::filesystem::copy(recording.root() / "data", elsewhere.path() / "data",
                        std::filesystem::copy_options::recursive);
  const ScopedVariable zone("TZ", "Asia/Kathmandu");
  ExpectSameFiles(here, RunIn(elsewhere.path(), "a"));
}

TEST(SameBytes, UnderADecimalComma) {
  const TemporaryFolder locales;
  const std::string make = "localedef -i de_DE -f UTF-8 " +
                           (locales.path() / "de_DE.utf8").string() +
                           " >/dev/null 2>&1";
  if (std::system(make.c_str()) != 0) {
    GTEST_SKIP() << "localedef cannot make de_DE (Debian: locales)";
  }
  const Recording recording;
  const auto plain = RunIn(recording.root(), "a");
  const ScopedVariable path("LOCPATH", locales.path().string());
  const ScopedVariable all("LC_ALL", "de_DE.utf8");
  const ScopedVariable language("LANG", "de_DE.utf8");
  ExpectSameFiles(plain, RunIn(recording.root(), "b"));
}

}  // namespace
}  // namespace hindsight
