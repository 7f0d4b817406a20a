#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "app/command_line.h"

namespace hindsight {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(Interrupt, LeavesNothingBehindAndEndsWith130) {
  const TemporaryFolder folder;
  ASSERT_EQ(Hindsight({"simulate", "car_drive", "--out=data", "--seed=1"},
                      folder.path())
                .status,
            0);
  for (const std::string stage : {"reading", "ekf", "batch"}) {
    Child run({"run", "data/config.yaml", "--out=out", "--methods=batch",
               "--rate=100", "--progress=json"},
              folder.path());
    while (run.Err().find('"' + stage + '"') == std::string::npos) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    run.Signal(SIGINT);
    const Outcome outcome = run.Wait();
    EXPECT_EQ(outcome.status, 130) << stage;
    EXPECT_EQ(Lines(outcome.err).back(), "hindsight: error: interrupted");
    // The start may have been reported; no result may.
    EXPECT_THAT(outcome.out, Not(HasSubstr("usable")));
    EXPECT_THAT(outcome.out, Not(HasSubstr("results in")));
    EXPECT_THAT(Names(folder.path()), ElementsAre("data"));
  }
}

}  // namespace
}  // namespace hindsight
