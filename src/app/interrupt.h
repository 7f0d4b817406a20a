#ifndef HINDSIGHT_APP_INTERRUPT_H_
#define HINDSIGHT_APP_INTERRUPT_H_

#include <functional>
#include <string>
#include <thread>

namespace hindsight {

/// From now on those of SIGINT, SIGTERM and SIGHUP that were not ignored (as of
/// a job in the background of a script, or under nohup) end the process with
/// kStopped, and a limit on the size of files makes writing fail instead of
/// ending the process.
void CatchSignals();

/// While it lives, the first of those signals has `finish` called on a thread
/// of its own, whatever the other threads are at, its words printed as the
/// error, and the process ended with kStopped by that thread. A second signal
/// ends the process at once; one within 50 ms is taken for the first, as some
/// programs signal both a process and its group. A closed pipe makes writing
/// fail instead of ending the process. At most one lives at a time, after
/// CatchSignals.
class StopWatch {
 public:
  explicit StopWatch(std::function<std::string()> finish);
  ~StopWatch();
  StopWatch(const StopWatch&) = delete;
  StopWatch& operator=(const StopWatch&) = delete;

 private:
  std::thread thread_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_APP_INTERRUPT_H_
