#include "io/read/text_table.h"

#include <gtest/gtest.h>

#include <string>

#include "base/error.h"
#include "base/parallel.h"
#include "support/temporary_folder.h"

namespace hindsight {
namespace {

/// Of batches that are parsed by other threads, and more.
constexpr int kLinesOfTable = 60000;

/// Lines "k,2 k" from 1 on, but for one.
std::string Lines(int other, const std::string& line) {
  std::string text;
  for (int k = 1; k <= kLinesOfTable; ++k) {
    text += k == other ? line
                       : std::to_string(k) + "," + std::to_string(2 * k) + "\n";
  }
  return text;
}

TableLayout TwoColumns() {
  TableLayout layout;
  layout.time_column = 0;
  layout.fields.push_back({"x", 1});
  return layout;
}

/// Reads all rows, which must come in their order, and the last of which is
/// `last`. Returns what is wrong with the next one, if anything.
std::string ErrorBehind(int last, const std::string& path) {
  int read = 0;
  std::string what;
  try {
    TextLines lines(path);
    TextTable table(&lines, TwoColumns(), {}, "");
    while (table.Next()) {
      ++read;
      EXPECT_EQ(table.line(), read);
      EXPECT_EQ(table.stamp().fraction, read);
      EXPECT_EQ(table.value(0), 2.0 * read);
    }
  } catch (const InputError& error) {
    what = error.what();
  }
  EXPECT_EQ(read, last);
  return what;
}

class ManyRows : public ::testing::TestWithParam<int> {
 protected:
  ManyRows() { SetThreadCount(GetParam()); }
  ~ManyRows() override { SetThreadCount(before_); }

  const int before_ = ThreadCount();
  const TemporaryFolder folder_;
};

TEST_P(ManyRows, ComeInTheOrderOfTheFile) {
  EXPECT_EQ(ErrorBehind(kLinesOfTable, folder_.Write("a", Lines(0, ""))), "");
}

TEST_P(ManyRows, StandBeforeWhatIsWrongBehindThem) {
  for (const int bad : {600, 20001, kLinesOfTable}) {
    const std::string path = folder_.Write("a", Lines(bad, "1,x\n"));
    EXPECT_EQ(ErrorBehind(bad - 1, path),
              path + ":" + std::to_string(bad) +
                  ": column 2 (x): 'x' is not a finite number");
  }
}

TEST_P(ManyRows, StandBeforeALineThatIsNoText) {
  for (const int bad : {1, 600, 20001, kLinesOfTable}) {
    const std::string path =
        folder_.Write("a", Lines(bad, std::string("1,\0\n", 4)));
    EXPECT_EQ(ErrorBehind(bad - 1, path), path + ":" + std::to_string(bad) +
                                              ": holds a NUL byte; expected "
                                              "text");
  }
}

INSTANTIATE_TEST_SUITE_P(Threads, ManyRows, ::testing::Values(1, 2, 7));

}  // namespace
}  // namespace hindsight
