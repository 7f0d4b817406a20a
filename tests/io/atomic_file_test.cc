#include "io/write/atomic_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <string>

#include "base/parallel.h"
#include "io/write/output_error.h"
#include "support/temporary_folder.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

TEST(AtomicFile, LeavesNothingUnlessCommitted) {
  const TemporaryFolder folder;
  {
    AtomicFile file(folder.Path("a.txt"));
    file.Write("half");
    EXPECT_EQ(folder.Entries().size(), 1u);
    EXPECT_EQ(folder.Read("a.txt"), "");
  }
  EXPECT_TRUE(folder.Entries().empty());
  folder.Write("a.txt", "old");
  WriteFileAtomically(folder.Path("a.txt"), "new");
  EXPECT_EQ(folder.Read("a.txt"), "new");
  EXPECT_THAT(folder.Entries(), UnorderedElementsAre("a.txt"));
}

TEST(AtomicFile, NamesThePathThatCannotBeWritten) {
  const TemporaryFolder folder;
  const std::string path = folder.Path("absent/a.txt");
  try {
    AtomicFile file(path);
    FAIL();
  } catch (const OutputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(path));
    EXPECT_THAT(error.what(), HasSubstr("No such file or directory"));
  }
  std::filesystem::create_directory(folder.Path("d"));
  EXPECT_THROW(WriteFileAtomically(folder.Path("d"), "x"), OutputError);
  EXPECT_THAT(folder.Entries(), UnorderedElementsAre("d"));
}

class AtomicFileOfLines : public ::testing::TestWithParam<int> {
 protected:
  AtomicFileOfLines() { SetThreadCount(GetParam()); }
  ~AtomicFileOfLines() override { SetThreadCount(before_); }

 private:
  int before_ = ThreadCount();
};
INSTANTIATE_TEST_SUITE_P(Threads, AtomicFileOfLines,
                         ::testing::Values(1, 2, 3));

TEST_P(AtomicFileOfLines, HasThemInTheirOrderBetweenWhatElseIsWritten) {
  const TemporaryFolder folder;
  AtomicFile file(folder.Path("a.txt"));
  std::string expected;
  // Some at once are buffered, many are written beside.
  for (const int lines : {3, 20000, 10, 4096, 0, 50000, 1}) {
    const auto count = static_cast<std::size_t>(lines);
    const std::string title = std::to_string(count) + " lines\n";
    file.Write(title);
    expected += title;
    const auto append = [](std::size_t i, std::string* out) {
      *out += std::to_string(i) + std::string(i % 97, 'x') + '\n';
    };
    file.WriteLines(count, append);
    for (std::size_t i = 0; i < count; ++i) append(i, &expected);
  }
  file.Commit();
  EXPECT_EQ(folder.Read("a.txt"), expected);
}

TEST_P(AtomicFileOfLines, GoToAnotherFileAsWellThatWantsThem) {
  const TemporaryFolder folder;
  AtomicFile all(folder.Path("all.txt"));
  AtomicFile some(folder.Path("some.txt"));
  std::string expected_of_all;
  std::string expected_of_some;
  const AtomicFile::Copy copy = {&some,
                                 [](std::size_t i) { return i % 3 == 1; }};
  const auto append = [](std::size_t i, std::string* out) {
    *out += std::to_string(i) + std::string(i % 97, 'x') + '\n';
  };
  for (const int lines : {1, 20000, 5, 50000}) {
    const auto count = static_cast<std::size_t>(lines);
    some.Write("title\n");
    expected_of_some += "title\n";
    all.WriteLines(count, append, &copy);
    for (std::size_t i = 0; i < count; ++i) {
      append(i, &expected_of_all);
      if (copy.has(i)) append(i, &expected_of_some);
    }
  }
  some.WriteLines(3, append);
  for (std::size_t i = 0; i < 3; ++i) append(i, &expected_of_some);
  all.Commit();
  some.Commit();
  EXPECT_EQ(folder.Read("all.txt"), expected_of_all);
  EXPECT_EQ(folder.Read("some.txt"), expected_of_some);
}

TEST_P(AtomicFileOfLines, SaysThatTheyCannotBeWrittenAndLeavesNothing) {
  const TemporaryFolder folder;
  rlimit before = {};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  // What fails is the last that is written, or that behind which others come.
  for (const int times : {1, 5}) {
    const rlimit limit = {1 << 20, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
    std::string what;
    try {
      AtomicFile file(folder.Path("a.txt"));
      for (int i = 0; i < times; ++i) {
        file.WriteLines(4096, [](std::size_t, std::string* out) {
          out->append(999, 'x') += '\n';
        });
      }
      file.Commit();
    } catch (const OutputError& error) {
      what = error.what();
    }
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_THAT(what, HasSubstr(folder.Path("a.txt")));
    EXPECT_THAT(what, HasSubstr("File too large"));
    EXPECT_TRUE(folder.Entries().empty());
  }
  std::signal(SIGXFSZ, handler);
}

}  // namespace
}  // namespace hindsight
