#ifndef HINDSIGHT_APP_PROGRESS_H_
#define HINDSIGHT_APP_PROGRESS_H_

#include <chrono>
#include <string>
#include <vector>

#include "base/step_fraction.h"

namespace hindsight {

/// Progress on stderr: on a terminal a bar over the whole run in one line that
/// is overwritten, with the time left; for programs one JSON object a line,
///   {"stage": "...", "fraction": 0.25, "seconds_left": 3.1,
///    "run_fraction": 0.1, "run_seconds_left": 27.0},
/// with seconds_left absent while it is unknown, and what is of the run while
/// there is no plan; the last has the stage "done", when the results are in
/// place.
///
/// Without a plan the bar is that of the stage. The run's fraction is what has
/// been done of the plan's work, of a step as StepFraction has it. The time left
/// is the time that this took, in the proportion of what is left; so the plan's
/// errors shrink as its steps are done.
class Progress {
 public:
  /// A part of a run.
  struct Step {
    std::string name;
    double work = 1.0;  ///< in any unit that all steps share
  };

  enum class Mode { kNone, kTerminal, kJson };

  /// "auto" (a terminal line if stderr is a terminal), "json" or "none".
  /// Throws UsageError for anything else.
  static Mode ModeFromName(const std::string& name);

  explicit Progress(Mode mode);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// What the run consists of; the first step begins.
  void Plan(std::vector<Step> steps);

  /// The step of that name begins, and those before it are done.
  void Begin(const std::string& step);

  /// `fraction` in [0, 1] of `stage`. Within a step stages may follow each
  /// other; the run's fraction never falls.
  void Update(const std::string& stage, double fraction);

  /// Clears the terminal line and tells programs that all is done.
  void Finish();

  /// Clears the terminal line, before other output.
  void Clear();

 private:
  using Clock = std::chrono::steady_clock;
  void Print(double fraction);
  void PrintBar() const;
  /// Of the run, if `step_fraction` is done of the step.
  double RunFraction(double step_fraction) const;
  double SecondsSince(Clock::time_point begin) const;

  Mode mode_;
  std::vector<Step> steps_;
  std::size_t step_ = 0;
  StepFraction step_fraction_;
  double stage_fraction_ = 0.0;
  Clock::time_point run_begin_ = Clock::now();
  Clock::time_point step_begin_ = run_begin_;
  std::string stage_;
  Clock::time_point stage_begin_;
  Clock::time_point last_print_;
  bool line_open_ = false;
};

}  // namespace hindsight

#endif  // HINDSIGHT_APP_PROGRESS_H_
