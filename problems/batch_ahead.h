#ifndef HINDSIGHT_PROBLEMS_BATCH_AHEAD_H_
#define HINDSIGHT_PROBLEMS_BATCH_AHEAD_H_

#include <atomic>
#include <functional>
#include <future>
#include <vector>

#include "problems/batch.h"

namespace hindsight {

/// SolveBatch on a thread of its own, while others judge the trajectory that it
/// starts from. It works on a copy of the problem as it is when this begins, so that
/// its result does not depend on who is the first.
class BatchAhead {
 public:
  /// `initial` must outlive the object.
  BatchAhead(const std::vector<State>& initial, BatchOptions options,
             Problem problem);
  /// Ends what nobody took.
  ~BatchAhead();
  BatchAhead(const BatchAhead&) = delete;
  BatchAhead& operator=(const BatchAhead&) = delete;

  /// Waits for the result, for one call; throws what SolveBatch and the callback of
  /// the options throw, which is called on this thread alone. `seconds` is what it
  /// took of a processor's time on other threads than the caller's.
  BatchResult Take(double* seconds);

 private:
  struct Solved {
    BatchResult result;
    double seconds = 0.0;
  };

  Solved Solve(const std::vector<State>& initial, BatchOptions options,
               Problem problem);

  std::function<void(double)> callback_;
  std::atomic<bool> abandoned_ = false;
  std::atomic<bool> solves_while_taken_ = false;  ///< on the caller's thread
  std::atomic<double> fraction_ = 0.0;
  std::future<Solved> solved_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_BATCH_AHEAD_H_
