#include "app/fault_matrix.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace hindsight {
namespace {

TEST_F(FaultMatrix, FreshFolder) { RunAll(false, {}, Stride(7), 60); }

TEST_F(FaultMatrix, ReplacedFolder) { RunAll(true, {}, Stride(13), 60); }

TEST_F(FaultMatrix, ReplacedFolderWithoutExchange) {
  RunAll(true, {{"_NO_EXCHANGE", "1"}}, Stride(29), 20);
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
