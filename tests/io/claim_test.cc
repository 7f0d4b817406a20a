#include "io/write/claim.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "support/temporary_folder.h"

namespace hindsight {
namespace {

constexpr double kStale = 60.0;  // [s]

/// As if its owner, on another machine, had last touched it so long ago.
void Leave(const std::filesystem::path& claim, const std::string& text,
           double seconds_ago) {
  std::ofstream(claim) << text;
  timespec now = {};
  clock_gettime(CLOCK_REALTIME, &now);
  now.tv_sec -= static_cast<time_t>(seconds_ago);
  const timespec times[2] = {now, now};
  ASSERT_EQ(utimensat(AT_FDCWD, claim.c_str(), times, 0), 0);
}

TEST(Claim, IsOneWorkersAtATime) {
  const TemporaryFolder folder;
  {
    const auto claim = Claim::Take(folder.Path(""), kStale);
    ASSERT_TRUE(claim);
    EXPECT_EQ(claim->note_before(), "");
    EXPECT_TRUE(claim->Beat());
    EXPECT_FALSE(Claim::Take(folder.Path(""), kStale));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.Path("")));
  EXPECT_TRUE(Claim::Take(folder.Path(""), kStale));
}

TEST(Claim, OfAnotherMachineIsDeadWhenItWasNotTouched) {
  const TemporaryFolder folder;
  Leave(folder.Path("claim.4"), "elsewhere\nkey\n", kStale - 30.0);
  EXPECT_FALSE(Claim::Take(folder.Path(""), kStale));
  Leave(folder.Path("claim.4"), "elsewhere\nkey\n", kStale + 30.0);
  const auto claim = Claim::Take(folder.Path(""), kStale);
  ASSERT_TRUE(claim);
  EXPECT_EQ(claim->note_before(), "key");
  EXPECT_TRUE(std::filesystem::exists(folder.Path("claim.5")));
}

TEST(Claim, OfATimeToComeIsThatOfAnOwnerBeforeTheClockWasSetBack) {
  const TemporaryFolder folder;
  Leave(folder.Path("claim.1"), "elsewhere\nkey\n", -(kStale - 30.0));
  EXPECT_FALSE(Claim::Take(folder.Path(""), kStale));
  Leave(folder.Path("claim.1"), "elsewhere\nkey\n", -(kStale + 30.0));
  EXPECT_TRUE(Claim::Take(folder.Path(""), kStale));
}

TEST(Claim, OfAKilledProcessHereIsDeadAtOnce) {
  const TemporaryFolder folder;
  const pid_t owner = fork();
  if (owner == 0) {
    auto claim = Claim::Take(folder.Path(""), kStale);
    claim->Note("half");
    kill(getpid(), SIGKILL);
  }
  waitpid(owner, nullptr, 0);
  ASSERT_TRUE(std::filesystem::exists(folder.Path("claim.1")));
  const auto claim = Claim::Take(folder.Path(""), kStale);
  ASSERT_TRUE(claim);
  EXPECT_EQ(claim->note_before(), "half");
}

TEST(Claim, OwnerThatWakesUpFindsItselfSuperseded) {
  const TemporaryFolder folder;
  auto first = Claim::Take(folder.Path(""), kStale);
  Leave(folder.Path("claim.1"), "elsewhere\nkey\n", 2.0 * kStale);
  {
    const auto second = Claim::Take(folder.Path(""), kStale);
    ASSERT_TRUE(second);
    EXPECT_FALSE(first->Beat());
    EXPECT_TRUE(second->Beat());
  }
  // The second has given it back, and a third has the first one's number.
  const auto third = Claim::Take(folder.Path(""), kStale);
  ASSERT_TRUE(third);
  EXPECT_FALSE(first->Beat());
  first.reset();
  EXPECT_TRUE(third->Beat());
}

TEST(Claim, TheServersClockIsThatOfItsFiles) {
  const TemporaryFolder folder;
  const double before = FileServerTime(folder.Path(""));
  std::ofstream(folder.Path("file")) << "x";
  struct stat status = {};
  ASSERT_EQ(stat((folder.Path("file")).c_str(), &status), 0);
  EXPECT_LE(before, static_cast<double>(status.st_mtim.tv_sec) + 1.0);
  EXPECT_GE(FileServerTime(folder.Path("")), before);
}

}  // namespace
}  // namespace hindsight
