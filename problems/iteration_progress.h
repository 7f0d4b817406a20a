#ifndef HINDSIGHT_PROBLEMS_ITERATION_PROGRESS_H_
#define HINDSIGHT_PROBLEMS_ITERATION_PROGRESS_H_

#include <functional>
#include <utility>

namespace hindsight {

/// How far solves that iterate until their steps are below a limit have come:
///   done / (done + left),   left = ln(ratio) / -ln(rate) + later,
/// `ratio` the last step over the limit and `rate` that of the last two steps,
/// which the steps to come are taken to keep. Iterations count alike, so that
/// the time left follows from what they have cost. Never goes back.
class IterationProgress {
 public:
  /// `report` may be empty, and may throw to stop.
  explicit IterationProgress(std::function<void(double fraction)> report)
      : report_(std::move(report)) {}

  /// A solve of at most `max_iterations` begins, after which `later` iterations
  /// are expected.
  void Begin(int max_iterations, double later);

  /// An iteration of it has ended, with number 0 the evaluation of its start.
  void After(int iteration, double ratio);

 private:
  std::function<void(double)> report_;
  int max_iterations_ = 0;
  double later_ = 0.0;
  double previous_ = 0.0;  ///< ratio; 0: none
  int done_ = 0;
  double fraction_ = 0.0;
};

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_ITERATION_PROGRESS_H_
