#ifndef HINDSIGHT_APP_CHILD_PROCESS_H_
#define HINDSIGHT_APP_CHILD_PROCESS_H_

#include <sys/types.h>

#include <filesystem>
#include <limits>
#include <mutex>
#include <set>
#include <string>
#include <vector>

namespace hindsight {

/// What another process may take.
struct ChildLimits {
  double seconds = std::numeric_limits<double>::infinity();  ///< by the clock
  /// Memory that it writes to (RLIMIT_DATA), beyond which it gets none [MB].
  double megabytes = std::numeric_limits<double>::infinity();
};

/// How it ended.
struct ChildEnd {
  int status = 0;  ///< of its exit
  int signal = 0;  ///< that ended it; 0: it ended by itself
  bool over_time = false;
  double seconds = 0.0;    ///< from its start to its end
  double megabytes = 0.0;  ///< largest memory that it held (RSS)
};

/// Runs this program again, in processes that end when it does, however it
/// ends. Any thread may call any member.
class Children {
 public:
  /// `hindsight words...`, which finds nothing on its standard input and adds
  /// its outputs to the file `log`, to its end. Beyond its time it is asked to
  /// end (SIGTERM), ten seconds later ended. Throws OutputError if `log` cannot
  /// be written, EstimationError if the system has no more processes.
  ChildEnd Run(std::vector<std::string> words, const std::filesystem::path& log,
               const ChildLimits& limits);

  /// Asks all that run to end; those that begin later are asked at once.
  void Stop();
  bool stopped() const;

 private:
  pid_t Start(std::vector<std::string> words, int log,
              const ChildLimits& limits);

  mutable std::mutex mutex_;
  std::set<pid_t> running_;
  bool stopped_ = false;
};

/// Standard output of another program, up to 1 MB of it, and whether it ended
/// with status 0. Its errors appear on standard error.
struct ProgramOutput {
  bool found = false;  ///< there is such a program
  bool succeeded = false;
  std::string text;
};
ProgramOutput RunProgram(std::vector<std::string> words);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_CHILD_PROCESS_H_
