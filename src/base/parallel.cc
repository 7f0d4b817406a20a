#include "base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <thread>

#include "base/processor_time.h"

namespace hindsight {
namespace {

std::atomic<int> thread_count = 0;  // 0: not set

}  // namespace

int ThreadCount() {
  const int set = thread_count;
  return set > 0 ? set : std::max(1, tbb::info::default_concurrency());
}

void SetThreadCount(int count) {
  static std::unique_ptr<tbb::global_control> limit;
  thread_count = std::max(1, count);
  limit = std::make_unique<tbb::global_control>(
      tbb::global_control::max_allowed_parallelism,
      static_cast<std::size_t>(thread_count));
}

void ForRanges(
    std::size_t count, std::size_t grain,
    const std::function<void(std::size_t begin, std::size_t end)>& body) {
  if (count == 0) return;
  if (ThreadCount() == 1 || count < 2 * grain) {
    body(0, count);
    return;
  }
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<double> seconds_of_others = 0.0;
  const auto run = [&](const tbb::blocked_range<std::size_t>& range) {
    if (std::this_thread::get_id() == caller) {
      body(range.begin(), range.end());
      return;
    }
    const double t0 = ProcessorSeconds();
    body(range.begin(), range.end());
    seconds_of_others += ProcessorSeconds() - t0;
  };
  // A thread that waits here must not take up other work meanwhile: that may be
  // a whole run, whose time would count as this one's.
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), run);
  });
  AddProcessorSeconds(seconds_of_others);
}

}  // namespace hindsight
