#ifndef HINDSIGHT_BASE_PARALLEL_H_
#define HINDSIGHT_BASE_PARALLEL_H_

#include <cstddef>
#include <functional>
#include <future>
#include <utility>

#include "base/background.h"

namespace hindsight {

/// Threads that ForRanges and InBackground use in the whole process: at first
/// as many as the process has cores.
int ThreadCount();
/// At least 1. Not while a ForRanges is under way.
void SetThreadCount(int count);

/// Calls body(begin, end) for ranges that together are 0 to count, each of about
/// `grain` or more, in any order and several at once. The result must not depend
/// on how the ranges are cut. Whatever a body throws is thrown, of several any
/// one of them.
void ForRanges(
    std::size_t count, std::size_t grain,
    const std::function<void(std::size_t begin, std::size_t end)>& body);

/// What `work` returns or throws: worked out beside on a thread of its own, with
/// a ThreadCount of 1 when it is asked for. The future waits in its destructor. What
/// `work` holds goes before the result can be had.
template <typename Work>
auto InBackground(Work work) {
  // The future of what waits, as that of a thread that is used again would not.
  return ThreadCount() > 1 ? std::async(std::launch::deferred,
                                        BackgroundWork<Work>(std::move(work)))
                           : std::async(std::launch::deferred, std::move(work));
}

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_PARALLEL_H_
