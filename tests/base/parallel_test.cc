#include "base/parallel.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <future>
#include <latch>
#include <memory>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "base/processor_time.h"

namespace hindsight {
namespace {

/// Threads for a test, and what there was afterwards.
class Threads {
 public:
  explicit Threads(int count) : before_(ThreadCount()) {
    SetThreadCount(count);
  }
  ~Threads() { SetThreadCount(before_); }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

 private:
  int before_;
};

TEST(ForRanges, CoversEachIndexOnce) {
  for (const int threads : {1, 2, 5}) {
    const Threads limit(threads);
    for (const std::size_t count :
         std::array<std::size_t, 5>{0, 1, 7, 64, 12345}) {
      std::vector<std::atomic<int>> seen(count);
      ForRanges(count, 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) ++seen[i];
      });
      for (std::size_t i = 0; i < count; ++i) {
        ASSERT_EQ(seen[i], 1) << i << " of " << count;
      }
    }
  }
}

TEST(ForRanges, MayStandInOneAnother) {
  const Threads limit(4);
  std::atomic<int> sum = 0;
  ForRanges(20, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      ForRanges(10, 1, [&](std::size_t from, std::size_t to) {
        sum += static_cast<int>(to - from);
      });
    }
  });
  EXPECT_EQ(sum, 200);
}

TEST(ForRanges, ThrowsWhatABodyThrows) {
  for (const int threads : {1, 4}) {
    const Threads limit(threads);
    EXPECT_THROW(ForRanges(100, 1,
                           [](std::size_t begin, std::size_t) {
                             if (begin >= 40 || begin == 0) {
                               throw std::runtime_error("here");
                             }
                           }),
                 std::runtime_error);
  }
}

TEST(ForRanges, CountsTheProcessorTimeOfAllThreads) {
  constexpr double kOfEach = 0.01;  // s
  constexpr int kCount = 16;
  for (const int threads : {1, 4}) {
    const Threads limit(threads);
    const double t0 = ProcessorSeconds();
    ForRanges(kCount, 1, [](std::size_t begin, std::size_t end) {
      const double from = ProcessorSeconds();
      while (ProcessorSeconds() - from <
             kOfEach * static_cast<double>(end - begin)) {
      }
    });
    const double seconds = ProcessorSeconds() - t0;
    EXPECT_GE(seconds, kCount * kOfEach) << threads;
    EXPECT_LT(seconds, 1.2 * kCount * kOfEach) << threads;
  }
}

TEST(InBackground, IsAThreadOfItsOwnUnlessThereIsOnlyOne) {
  const std::thread::id here = std::this_thread::get_id();
  {
    const Threads limit(2);
    EXPECT_NE(InBackground([] { return std::this_thread::get_id(); }).get(),
              here);
  }
  const Threads limit(1);
  EXPECT_EQ(InBackground([] { return std::this_thread::get_id(); }).get(),
            here);
}

/// Of an idle thread a process that is forked has the memory alone.
TEST(InBackground, IsDoneInAForkedProcess) {
  constexpr int kDone = 7;
  const Threads limit(2);
  InBackground([] {}).get();
  const pid_t child = fork();
  if (child == 0) {
    alarm(20);
    _exit(InBackground([] { return kDone; }).get());
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status)) << "ended by signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), kDone);
}

TEST(InBackground, ThrowsWhereItIsAskedFor) {
  for (const int threads : {1, 2}) {
    const Threads limit(threads);
    auto work = InBackground([]() -> int { throw std::runtime_error("late"); });
    EXPECT_THROW(work.get(), std::runtime_error);
  }
}

TEST(InBackground, IsDoneBesideWithoutBeingAskedFor) {
  const Threads limit(2);
  std::promise<void> begun;
  auto work = InBackground([&begun] { begun.set_value(); });
  begun.get_future().wait();
  work.get();
}

TEST(InBackground, IsWaitedForByTheFuture) {
  const Threads limit(2);
  for (const bool shared : {false, true}) {
    std::atomic<bool> done = false;
    {
      auto work = InBackground([&done] {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        done = true;
      });
      if (shared) auto same = work.share();
    }
    EXPECT_TRUE(done);
  }
}

TEST(InBackground, HasLetGoWhatItHeld) {
  for (const int threads : {1, 2}) {
    const Threads limit(threads);
    for (int i = 0; i < 100; ++i) {
      const auto held = std::make_shared<int>(i);
      auto work = InBackground([own = held] { return *own; });
      EXPECT_EQ(work.get(), i);
      if (threads > 1) {
        EXPECT_EQ(held.use_count(), 1);
      }
    }
  }
}

TEST(InBackground, TakesAThreadAgain) {
  const Threads limit(2);
  std::set<std::thread::id> threads;
  for (int i = 0; i < 100; ++i) {
    threads.insert(
        InBackground([] { return std::this_thread::get_id(); }).get());
  }
  EXPECT_EQ(threads.size(), 1U);
}

TEST(InBackground, NeverWaitsForAThread) {
  const Threads limit(2);
  constexpr std::size_t kCount = 20;
  std::latch all_begun(kCount);
  std::vector<std::future<int>> works;
  for (std::size_t i = 0; i < kCount; ++i) {
    works.push_back(InBackground([&all_begun, i] {
      all_begun.arrive_and_wait();
      return InBackground([i] { return static_cast<int>(i); }).get();
    }));
  }
  for (std::size_t i = 0; i < kCount; ++i) {
    EXPECT_EQ(works[i].get(), static_cast<int>(i));
  }
}

TEST(ThreadCount, IsAtLeastOne) {
  EXPECT_GE(ThreadCount(), 1);
  const Threads limit(0);
  EXPECT_EQ(ThreadCount(), 1);
}

}  // namespace
}  // namespace hindsight
