#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>

#include "app/faults.h"
#include "app/recording.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

class Publish : public ::testing::Test {
 protected:
  fs::path root() const { return recording_.root(); }
  Outcome Simulate(std::vector<std::string> words) const {
    words.insert(words.begin(), {"simulate", "short_drive", "--duration=5"});
    return Hindsight(words, root());
  }
  /// Refused with status 2 and these words, and nothing changed.
  void ExpectRefused(const std::vector<std::string>& words,
                     const std::vector<std::string>& expected) const {
    const auto list = [&] {
      std::vector<std::string> all;
      for (const auto& entry : fs::recursive_directory_iterator(root())) {
        all.push_back(entry.path().string() +
                      (entry.is_regular_file() ? ReadFile(entry) : ""));
      }
      std::sort(all.begin(), all.end());
      return all;
    };
    const std::vector<std::string> before = list();
    const Outcome outcome = Hindsight(words, root());
    EXPECT_EQ(outcome.status, 2) << ::testing::PrintToString(words);
    for (const std::string& word : expected) {
      EXPECT_THAT(outcome.err, HasSubstr(word));
    }
    EXPECT_EQ(list(), before) << ::testing::PrintToString(words);
  }
  Recording recording_;
};

TEST_F(Publish, AFolderThatAppearsMeanwhileStays) {
  Child run({"run", "data/config.yaml", "--out=out", "--methods=ekf,batch",
             "--progress=json"},
            root());
  ASSERT_TRUE(run.PauseAt("ekf"));
  fs::create_directory(root() / "out");
  WriteFile(root() / "out" / "thesis.txt", "mine");
  run.Resume();
  const Outcome outcome = run.Wait();
  EXPECT_EQ(outcome.status, 4);
  EXPECT_THAT(Lines(outcome.err).back(),
              AllOf(HasSubstr((root() / "out").string()),
                    HasSubstr((root() / "out.1").string())));
  EXPECT_THAT(Names(root() / "out"), ElementsAre("thesis.txt"));
  EXPECT_THAT(Names(root() / "out.1"), ::testing::Contains("batch.csv"));
  EXPECT_THAT(Names(root()), UnorderedElementsAre("data", "out", "out.1"));
}

TEST_F(Publish, WithForceAFolderThatAppearsMeanwhileStaysToo) {
  Child run({"run", "data/config.yaml", "--out=out", "--methods=ekf,batch",
             "--progress=json", "--force"},
            root());
  ASSERT_TRUE(run.PauseAt("ekf"));
  ASSERT_EQ(Simulate({"--out=out"}).status, 0);
  run.Resume();
  const Outcome outcome = run.Wait();
  EXPECT_EQ(outcome.status, 4);
  EXPECT_THAT(Names(root() / "out"), ::testing::Contains("imu.csv"));
  EXPECT_THAT(Names(root() / "out.1"), ::testing::Contains("batch.csv"));
}

TEST_F(Publish, AnEmptyFolderIsFilled) {
  fs::create_directory(root() / "out");
  EXPECT_EQ(recording_.Run({"--out=out", "--methods=ekf"}).status, 0);
  EXPECT_THAT(Names(root()), UnorderedElementsAre("data", "out"));
}

TEST_F(Publish, ForceNeverTakesAFolderThatHoldsAnInput) {
  const auto words = [&](const std::string& config, const std::string& out) {
    return std::vector<std::string>{"run", config, "--out=" + out,
                                    "--methods=ekf", "--force"};
  };
  // The recording is nothing but files of its manifest.
  ExpectRefused(words("data/config.yaml", "data"),
                {"data", "which is an input"});
  ExpectRefused(words("data/config.yaml", "."), {"which is an input"});
  // The configuration elsewhere, its files through a link.
  fs::create_directory_symlink("data", root() / "link");
  fs::create_directory(root() / "elsewhere");
  WriteFile(root() / "elsewhere" / "config.yaml",
            "folder: " + (root() / "link").string() + "\n" +
                ReadFile(recording_.file("config.yaml")));
  ExpectRefused(words("elsewhere/config.yaml", "data"), {"imu.csv"});
  ExpectRefused(words("elsewhere/config.yaml", "link"), {"imu.csv"});
  ExpectRefused(words("elsewhere/config.yaml", "elsewhere"), {"config.yaml"});
  // A link to its folder.
  fs::create_directory_symlink("data", root() / "links");
  ExpectRefused(words("links/config.yaml", "data"), {"which is an input"});
  // The list of times.
  ASSERT_EQ(recording_.Run({"--out=out", "--methods=ekf"}).status, 0);
  WriteFile(root() / "out" / "times", "5\n");
  std::vector<std::string> at = words("data/config.yaml", "out");
  at.emplace_back("--at=out/times");
  ExpectRefused(at, {"times", "which is an input"});
  // A scenario and a profile.
  ASSERT_EQ(Simulate({"--out=made"}).status, 0);
  ExpectRefused({"simulate", "car_drive", "--profile=made/truth.csv",
                 "--out=made", "--force"},
                {"truth.csv", "which is an input"});
}

TEST_F(Publish, FilesOfStreamsThatAreLeftOutAreInputs) {
  ASSERT_EQ(Simulate({"--out=made"}).status, 0);
  fs::copy(root() / "made", root() / "elsewhere");
  std::string config = ReadFile(root() / "elsewhere" / "config.yaml");
  const std::string key = "file: gnss.csv";
  ASSERT_NE(config.find(key), std::string::npos) << config;
  config.replace(config.find(key), key.size(), "file: ../made/gnss.csv");
  WriteFile(root() / "elsewhere" / "config.yaml", config);
  ExpectRefused({"run", "elsewhere/config.yaml", "--out=made", "--force",
                 "--without=gnss", "--methods=ekf"},
                {"made/gnss.csv", "which is an input"});
}

/// The temporary folder of a run that goes on.
fs::path PartialOf(const fs::path& folder) {
  for (const std::string& name : Names(folder)) {
    if (name.starts_with(".out.partial-")) return folder / name;
  }
  throw std::runtime_error("no temporary folder");
}

TEST_F(Publish, WhatOthersPutIntoTheTemporaryFolderStaysTheirs) {
  const auto run = [&](const std::string& methods) {
    return std::vector<std::string>{"run", "data/config.yaml", "--out=out",
                                    "--methods=" + methods, "--progress=json"};
  };
  {
    Child child(run("ekf,batch"), root());
    ASSERT_TRUE(child.PauseAt("batch"));
    WriteFile(PartialOf(root()) / "thesis.txt", "mine");
    child.Resume();
    const Outcome outcome = child.Wait();
    EXPECT_TRUE(HasResults(outcome)) << outcome.err;
  }
  EXPECT_EQ(ReadFile(root() / "out" / "thesis.txt"), "mine");
  EXPECT_THAT(
      ReadFile(root() / "out" / "manifest.json"),
      AllOf(HasSubstr("batch.csv"), ::testing::Not(HasSubstr("thesis.txt"))));
  fs::remove_all(root() / "out");
  // Of a run that ends with nothing finished.
  Child child(run("batch"), root());
  ASSERT_TRUE(child.PauseAt("ekf"));
  WriteFile(PartialOf(root()) / "thesis.txt", "mine");
  child.Signal(SIGTERM);
  child.Resume();
  const Outcome outcome = child.Wait();
  EXPECT_EQ(outcome.status, 130);
  const fs::path left = PartialOf(root());
  EXPECT_THAT(Names(left), ElementsAre("thesis.txt"));
  EXPECT_THAT(Lines(outcome.err).back(),
              AllOf(HasSubstr("nothing is left but " + left.string()),
                    HasSubstr("thesis.txt")));
}

TEST_F(Publish, AFolderAboveThatIsRenamedMeanwhileIsFollowed) {
  const std::vector<std::string> words = {
      "run", "data/config.yaml", "--out=above/out", "--methods=ekf,rts,batch",
      "--progress=json"};
  for (const std::string stage : {"ekf", "batch"}) {
    fs::create_directory(root() / "above");
    Child run(words, root());
    ASSERT_TRUE(run.PauseAt(stage));
    fs::rename(root() / "above", root() / "moved");
    run.Resume();
    const Outcome outcome = run.Wait();
    EXPECT_EQ(outcome.status, 4) << outcome.err;
    const std::string said = Lines(outcome.err).back();
    EXPECT_THAT(said, HasSubstr((root() / "above" / "out").string()));
    if (stage == "batch") {
      const fs::path left = root() / "moved" / "out.1";
      EXPECT_THAT(said, HasSubstr("what was finished is in " + left.string()));
      EXPECT_THAT(Names(left), ::testing::Contains("ekf.csv"));
      EXPECT_THAT(Names(root() / "moved"), ElementsAre("out.1"));
    } else {
      EXPECT_THAT(said, HasSubstr("nothing is left"));
      EXPECT_THAT(Names(root() / "moved"), ElementsAre());
    }
    EXPECT_FALSE(fs::exists(root() / "above"));
    fs::remove_all(root() / "moved");
  }
}

TEST_F(Publish, TooFewFileDescriptorsAreOneLineAndLeaveNothing) {
  if (!CanInjectFaults()) GTEST_SKIP() << "a sanitizer takes some itself";
  const std::vector<std::vector<std::string>> commands = {
      {"run", "data/config.yaml", "--out=out", "--methods=ekf"},
      {"simulate", "short_drive", "--duration=5", "--out=out"},
      {"montecarlo", "tunnel_survey", "--runs=2", "--out=out"}};
  for (const std::vector<std::string>& words : commands) {
    const rlimit few = {4, 4};
    const Outcome outcome = Hindsight(words, root(), [&few] {
      for (int fd = STDERR_FILENO + 1; fd < 20; ++fd) close(fd);
      setrlimit(RLIMIT_NOFILE, &few);
    });
    EXPECT_TRUE(outcome.status == 2 || outcome.status == 4)
        << words[0] << outcome.status;
    EXPECT_EQ(Lines(outcome.err).size(), 1u) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("Too many open files"));
    EXPECT_THAT(Names(root()), ElementsAre("data")) << outcome.err;
  }
}

TEST_F(Publish, ForceReplacesNothingButFilesOfTheManifest) {
  ASSERT_EQ(Simulate({"--out=made"}).status, 0);
  ASSERT_EQ(recording_.Run({"--out=out", "--methods=ekf"}).status, 0);
  for (const std::string folder : {"made", "out"}) {
    const std::vector<std::string> words =
        folder == "made"
            ? std::vector<std::string>{"simulate", "car_drive", "--duration=5",
                                       "--out=made", "--force"}
            : std::vector<std::string>{"run", "data/config.yaml", "--out=out",
                                       "--methods=ekf", "--force"};
    WriteFile(root() / folder / "thesis.txt", "mine");
    ExpectRefused(words, {folder, "thesis.txt"});
    fs::remove(root() / folder / "thesis.txt");
    fs::create_directory(root() / folder / "photos");
    ExpectRefused(words, {folder, "photos"});
    fs::remove(root() / folder / "photos");
    // A link is not the file that was written.
    const std::string file = folder == "made" ? "imu.csv" : "ekf.csv";
    fs::rename(root() / folder / file, root() / file);
    fs::create_symlink(root() / file, root() / folder / file);
    ExpectRefused(words, {folder, file, "which is a symbolic link"});
    fs::remove(root() / folder / file);
    fs::rename(root() / file, root() / folder / file);
    EXPECT_EQ(Hindsight(words, root()).status, 0);
    fs::remove(root() / folder / "manifest.json");
    ExpectRefused(words, {folder, "manifest.json"});
  }
  // A folder of the user's own with a config.yaml in it.
  fs::create_directories(root() / "real" / "photos");
  WriteFile(root() / "real" / "config.yaml", "name: mine\n");
  ExpectRefused({"simulate", "short_drive", "--out=real", "--force"},
                {"manifest.json"});
}

TEST_F(Publish, CleanRemovesNothingButFilesOfTheProgram) {
  const std::string name = ".out.partial-0123456789ab";
  const fs::path left = root() / name;
  const std::vector<std::string> words = {"run", "data/config.yaml",
                                          "--out=out", "--methods=ekf"};
  std::vector<std::string> clean = words;
  clean.emplace_back("--clean");
  fs::create_directory(left);
  WriteFile(left / "thesis.txt", "mine");
  ExpectRefused(clean, {name, "thesis.txt", "--clean does not remove it"});
  const std::string manifest =
      R"({"program": "hindsight", "complete": false, "files": ["ekf.csv"]})";
  WriteFile(left / "manifest.json", manifest);
  WriteFile(left / "ekf.csv", "");
  ExpectRefused(clean, {name, "thesis.txt"});
  fs::rename(left / "thesis.txt", left / ".rts.csv.partial-0123456789ab");
  ExpectRefused(clean, {name, ".rts.csv.partial-0123456789ab"});
  fs::remove(left / ".rts.csv.partial-0123456789ab");
  fs::create_directory(left / "photos");
  ExpectRefused(clean, {name, "photos"});
  // Without the request it is named, and in no run's way.
  const Outcome named = Hindsight(words, root());
  EXPECT_EQ(named.status, 0);
  EXPECT_THAT(named.err, AllOf(HasSubstr(name), HasSubstr("photos")));
  EXPECT_TRUE(fs::exists(left / "photos"));
  fs::remove_all(root() / "out");
  fs::remove(left / "photos");
  // A manifest of another program lists nothing.
  WriteFile(left / "manifest.json", R"({"files": ["ekf.csv"]})");
  ExpectRefused(clean, {name, "ekf.csv"});
  WriteFile(left / "manifest.json", manifest);
  WriteFile(left / ".ekf.csv.partial-0123456789ab", "t[s]");
  const Outcome outcome = Hindsight(clean, root());
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(Names(root()), UnorderedElementsAre("data", "out"));
}

TEST_F(Publish, CleanRemovesNoFileOfOthers) {
  WriteFile(root() / ".out.partial-0123456789ab", "mine");
  ExpectRefused({"simulate", "short_drive", "--out=out", "--clean"},
                {".out.partial-0123456789ab", "is no folder"});
  const fs::path left = root() / ".new.yaml.partial-0123456789ab";
  const std::vector<std::string> words = {"init", "data", "--out=new.yaml",
                                          "--clean"};
  WriteFile(left, "mine");
  ExpectRefused(words, {left.filename(), "was not written by 'init'"});
  for (const std::string& own :
       {std::string(), Hindsight({"init", "data"}, root()).out}) {
    WriteFile(left, own);
    fs::remove(root() / "new.yaml");
    EXPECT_EQ(Hindsight(words, root()).status, 0);
    EXPECT_FALSE(fs::exists(left));
  }
}

TEST_F(Publish, TheWorkingDirectoryAndWhatHoldsItAreNotReplaced) {
  fs::create_directories(root() / "here" / "below");
  fs::create_directory_symlink("here", root() / "link");
  const fs::path below = root() / "here" / "below";
  for (const std::string out :
       {".", "./", "..", "../", "../below", "../below/", "../../link/below",
        "../../link/below/", "../../link", "../../link/", "/"}) {
    for (const std::string flag : {"--force", "--clean"}) {
      const Outcome outcome = Hindsight(
          {"simulate", "short_drive", "--duration=5", "--out=" + out, flag},
          below);
      EXPECT_EQ(outcome.status, 2) << out;
      ASSERT_EQ(Lines(outcome.err).size(), 1u) << outcome.err;
      EXPECT_THAT(outcome.err, HasSubstr("the working directory")) << out;
    }
  }
  EXPECT_THAT(Names(below), ElementsAre());
  EXPECT_THAT(Names(root() / "here"), ElementsAre("below"));
  // A folder of the working directory, with a slash behind, through a link.
  int made = 0;
  for (const std::string out : {"new/", "./other/.", "../../link/third/"}) {
    const Outcome outcome = Hindsight(
        {"simulate", "short_drive", "--duration=5", "--out=" + out}, below);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    ++made;
  }
  EXPECT_EQ(made, 3);
  EXPECT_THAT(Names(below), ElementsAre("new", "other"));
  EXPECT_THAT(Names(root() / "here"), ElementsAre("below", "third"));
  EXPECT_TRUE(fs::is_symlink(root() / "link"));
}

TEST_F(Publish, OutBehindALinkIsWhereTheSystemFindsIt) {
  fs::create_directories(root() / "disk" / "deep");
  fs::create_directory_symlink("disk/deep", root() / "link");
  EXPECT_EQ(Simulate({"--out=link/../out"}).status, 0);
  EXPECT_THAT(Names(root() / "disk"), ElementsAre("deep", "out"));
}

TEST_F(Publish, OutThatIsALinkFillsWhatItLeadsTo) {
  fs::create_directories(root() / "disk" / "out");
  fs::create_directory_symlink("disk/out", root() / "out");
  EXPECT_EQ(recording_.Run({"--out=out", "--methods=ekf"}).status, 0);
  EXPECT_TRUE(fs::is_symlink(root() / "out"));
  EXPECT_TRUE(fs::exists(root() / "disk" / "out" / "ekf.csv"));
}

TEST_F(Publish, InitReplacesWhatItWroteAlone) {
  const std::vector<std::string> words = {"init", "data", "--out=data/imu.csv",
                                          "--force"};
  ExpectRefused(words, {"imu.csv", "init"});
  ExpectRefused({"init", "data", "--out=data/config.yaml", "--force"},
                {"config.yaml", "init"});
  ExpectRefused({"init", "data", "--out=absent/config.yaml"}, {"absent"});
  EXPECT_EQ(Hindsight({"init", "data", "--out=new.yaml"}, root()).status, 0);
  EXPECT_EQ(
      Hindsight({"init", "data", "--out=new.yaml", "--force"}, root()).status,
      0);
}

TEST_F(Publish, AFileOfAnotherOrADeviceIsNotReplaced) {
  ASSERT_EQ(recording_.Run({"--out=out", "--methods=ekf"}).status, 0);
  ASSERT_EQ(mkfifo((root() / "pipe").c_str(), 0600), 0);
  fs::create_symlink("/dev/null", root() / "null");
  fs::create_directory(root() / "folder");
  const std::vector<std::vector<std::string>> writers = {
      {"report", "out"},
      {"evaluate", "out/ekf.csv", "data/truth.csv"},
      {"init", "data"}};
  for (std::vector<std::string> words : writers) {
    words.emplace_back("--force");
    for (const std::string taken : {"pipe", "null", "folder"}) {
      // A folder takes the configurations of the recordings below FOLDER.
      if (words[0] == "init" && taken == "folder") continue;
      words.push_back("--out=" + taken);
      ExpectRefused(words, {taken, "no regular file"});
      words.back() = "--out=data/imu.csv";
      ExpectRefused(words, {"imu.csv", "--force does not replace it"});
      words.back() = "--out=absent/page.html";
      ExpectRefused(words, {"there is no folder"});
      words.pop_back();
    }
    words.emplace_back("--out=new");
    EXPECT_EQ(Hindsight(words, root()).status, 0);
    EXPECT_EQ(Hindsight(words, root()).status, 0);
    fs::remove(root() / "new");
  }
  EXPECT_TRUE(fs::is_fifo(root() / "pipe"));
  EXPECT_TRUE(fs::is_symlink(root() / "null"));
}

TEST_F(Publish, ClosedStandardOutputLeavesCompleteResultsUsable) {
  const auto close_output = [] { close(STDOUT_FILENO); };
  const auto fill_output = [] {
    dup2(open("/dev/full", O_WRONLY), STDOUT_FILENO);
  };
  ASSERT_EQ(recording_.Run({"--out=open", "--methods=ekf"}).status, 0);
  for (const std::function<void()>& prepare :
       {std::function<void()>(close_output),
        std::function<void()>(fill_output)}) {
    const Outcome run =
        Hindsight({"run", "data/config.yaml", "--out=out", "--methods=ekf"},
                  root(), prepare);
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("standard output cannot be written"));
    EXPECT_THAT(run.err, ::testing::Not(HasSubstr("error")));
    for (const std::string file : {"ekf.csv", "residuals.csv"}) {
      EXPECT_EQ(ReadFile(root() / "out" / file),
                ReadFile(root() / "open" / file));
    }
    fs::remove_all(root() / "out");
    const Outcome check =
        Hindsight({"check", "data/config.yaml"}, root(), prepare);
    EXPECT_EQ(check.status, 4);
  }
}

TEST_F(Publish, AClosedPipeDoesNotEndARun) {
  const Outcome run = Hindsight(
      {"run", "data/config.yaml", "--out=out", "--methods=ekf"}, root(), [] {
        int ends[2];
        if (pipe(ends) != 0) _exit(125);
        close(ends[0]);
        dup2(ends[1], STDOUT_FILENO);
      });
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(Names(root()), UnorderedElementsAre("data", "out"));
}

TEST_F(Publish, ResultsThatAppearInAnEmptyFolderMeanwhileStay) {
  ASSERT_EQ(Simulate({"--out=other"}).status, 0);
  fs::create_directory(root() / "out");
  Child run({"run", "data/config.yaml", "--out=out", "--methods=ekf,batch",
             "--progress=json"},
            root());
  ASSERT_TRUE(run.PauseAt("ekf"));
  fs::copy(root() / "other", root() / "out");
  run.Resume();
  const Outcome outcome = run.Wait();
  EXPECT_EQ(outcome.status, 4);
  EXPECT_THAT(outcome.err, HasSubstr("no longer empty"));
  EXPECT_EQ(Names(root() / "out"), Names(root() / "other"));
  EXPECT_TRUE(fs::exists(root() / "out.1" / "summary.json"));
}

/// A file system gives the number of a folder that is gone to the next.
TEST_F(Publish, AnotherFolderOfTheSameNameStays) {
  ASSERT_EQ(Simulate({"--out=out"}).status, 0);
  Child run({"run", "data/config.yaml", "--out=out", "--force",
             "--methods=ekf,batch", "--progress=json"},
            root());
  ASSERT_TRUE(run.PauseAt("ekf"));
  fs::remove_all(root() / "out");
  ASSERT_EQ(Simulate({"--out=out"}).status, 0);
  run.Resume();
  const Outcome outcome = run.Wait();
  EXPECT_EQ(outcome.status, 4);
  EXPECT_THAT(outcome.err,
              HasSubstr("is not the one that was there at the start"));
  EXPECT_TRUE(fs::exists(root() / "out" / "truth.csv"));
  EXPECT_TRUE(fs::exists(root() / "out.1" / "summary.json"));
}

TEST_F(Publish, AProfileThatAScenarioNamesIsAnInput) {
  ASSERT_EQ(Simulate({"--out=own"}).status, 0);
  WriteFile(root() / "moved.yaml",
            "profile: own/truth.csv\n"
            "imu:\n  rate: 100 Hz\n  noise: {gyro: 0.1 deg/sqrt(h), "
            "accel: 0.05 m/s/sqrt(h)}\n");
  ExpectRefused({"simulate", "moved.yaml", "--out=own", "--force"},
                {"own/truth.csv", "which is an input"});
  EXPECT_EQ(Hindsight({"simulate", "moved.yaml", "--out=new"}, root()).status,
            0);
}

TEST_F(Publish, ADraftThatWasCompletedIsNotReplaced) {
  const std::vector<std::string> words = {"init", "data", "--out=c.yaml",
                                          "--force"};
  ASSERT_EQ(Hindsight(words, root()).status, 0);
  EXPECT_EQ(Hindsight(words, root()).status, 0);
  WriteFile(root() / "c.yaml",
            ReadFile(root() / "c.yaml") + "# my own addition\n");
  ExpectRefused(words, {"c.yaml", "is not as 'init' wrote it"});
}

}  // namespace
}  // namespace hindsight
