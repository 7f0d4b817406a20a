#include "problems/batch_ahead.h"

#include <chrono>
#include <utility>

#include "base/error.h"
#include "base/freed_memory.h"
#include "base/parallel.h"
#include "base/processor_time.h"

namespace hindsight {

BatchAhead::BatchAhead(const std::vector<State>& initial, BatchOptions options,
                       Problem problem)
    : callback_(std::exchange(options.callback, nullptr)),
      solved_(InBackground([this, &initial, options = std::move(options),
                            problem = std::move(problem)]() mutable {
        Solved solved = Solve(initial, std::move(options), std::move(problem));
        ReleaseFreedMemory();
        return solved;
      })) {}

BatchAhead::~BatchAhead() { abandoned_ = true; }

BatchAhead::Solved BatchAhead::Solve(const std::vector<State>& initial,
                                     BatchOptions options, Problem problem) {
  options.callback = [this](double fraction) {
    if (abandoned_) throw Interrupted();
    fraction_ = fraction;
    if (solves_while_taken_ && callback_) callback_(fraction);
  };
  const double t0 = ProcessorSeconds();
  Solved solved{SolveBatch(initial, options, &problem)};
  solved.seconds = ProcessorSeconds() - t0;
  return solved;
}

BatchResult BatchAhead::Take(double* seconds) {
  constexpr std::chrono::milliseconds kBetweenCalls(50);
  const double t0 = ProcessorSeconds();
  std::future_status status = std::future_status::timeout;
  while (status == std::future_status::timeout) {
    if (callback_) callback_(fraction_);
    status = solved_.wait_for(kBetweenCalls);
  }
  solves_while_taken_ = status == std::future_status::deferred;
  Solved solved = solved_.get();
  *seconds = solved.seconds - (ProcessorSeconds() - t0);
  return std::move(solved.result);
}

}  // namespace hindsight
