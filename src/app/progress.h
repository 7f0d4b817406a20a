#ifndef HINDSIGHT_APP_PROGRESS_H_
#define HINDSIGHT_APP_PROGRESS_H_

#include <chrono>
#include <string>

namespace hindsight {

/// Progress on stderr: on a terminal one line that is overwritten, with the
/// time left; for programs one JSON object a line,
///   {"stage": "...", "fraction": 0.25, "seconds_left": 3.1},
/// with seconds_left absent while it is unknown; the last has the stage "done",
/// when the results are in place.
class Progress {
 public:
  enum class Mode { kNone, kTerminal, kJson };

  /// "auto" (a terminal line if stderr is a terminal), "json" or "none".
  /// Throws UsageError for anything else.
  static Mode ModeFromName(const std::string& name);

  explicit Progress(Mode mode);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `fraction` in [0, 1] of `stage`; the time left is that of the stage.
  void Update(const std::string& stage, double fraction);

  /// Clears the terminal line and tells programs that all is done.
  void Finish();

  /// Clears the terminal line, before other output.
  void Clear();

 private:
  using Clock = std::chrono::steady_clock;
  void Print(double fraction, double seconds);

  Mode mode_;
  std::string stage_;
  Clock::time_point stage_begin_;
  Clock::time_point last_print_;
  bool line_open_ = false;
};

}  // namespace hindsight

#endif  // HINDSIGHT_APP_PROGRESS_H_
