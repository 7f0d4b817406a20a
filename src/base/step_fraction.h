#ifndef HINDSIGHT_BASE_STEP_FRACTION_H_
#define HINDSIGHT_BASE_STEP_FRACTION_H_

namespace hindsight {

/// What is done of a step that tells its fraction again and again, of passes that
/// nobody can count beforehand. Behind the one that goes on as many more as usual are
/// expected, each as long as the longest so far:
///   done = (time so far) / (time of a pass),
///   left = (what is left of the pass) + (more passes),
///   fraction = done / (done + left).
class StepFraction {
 public:
  /// `more_passes`: expected behind each.
  explicit StepFraction(double more_passes = 1.0) : more_passes_(more_passes) {}

  /// `fraction` in [0, 1] of a pass is done, `seconds` after the step began. Where it
  /// falls the pass before has ended.
  void Take(double seconds, double fraction);

  /// As the last pass told; may fall where one takes longer than those before.
  double now() const { return now_; }
  /// The most so far.
  double most() const { return most_; }

 private:
  double more_passes_;
  double pass_begin_ = 0.0;  ///< [s]
  double last_seconds_ = 0.0;
  double last_fraction_ = 0.0;
  double longest_ = 0.0;  ///< pass [s]
  double now_ = 0.0;
  double most_ = 0.0;
};

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_STEP_FRACTION_H_
