#ifndef HINDSIGHT_RECEIVER_ERRORS_HELD_OUT_PREDICTION_H_
#define HINDSIGHT_RECEIVER_ERRORS_HELD_OUT_PREDICTION_H_

#include <optional>
#include <vector>

#include "receiver_errors/held_out_score.h"
#include "receiver_errors/sequence_splice.h"

namespace hindsight {

/// Predicts the fixes of stretches that are held out (ScoreHeldOut) about one
/// hypothesis.
class HeldOutPrediction {
 public:
  /// The tape must outlive this.
  HeldOutPrediction(const SensorTape& tape, const Hypothesis& hypothesis);

  HeldOutScore Score(const HeldOutStretch& stretch);

 private:
  /// Of one fix.
  struct Prediction {
    double log = 0.0;     ///< of its density
    double square = 0.0;  ///< of its distance [stated sigma^2]
  };

  /// The last step within that changes the sensor's error.
  std::optional<ErrorStep> LastChange(const HeldOutStretch& stretch) const;
  /// Of each fix, if the mode changes at the begin or at the end of the stretch.
  std::vector<Prediction> Predict(const HeldOutStretch& stretch,
                                  std::optional<ErrorStep> at_begin,
                                  std::optional<ErrorStep> at_end);
  /// With what was `predicted` from before at each node from `first` on.
  std::vector<Prediction> Join(const HeldOutStretch& stretch, std::size_t first,
                               const std::vector<Gaussian>& predicted,
                               const std::vector<ErrorStep>& steps,
                               std::optional<ErrorStep> at_end);
  Prediction PredictFix(const Gaussian& x, std::size_t k) const;

  SequenceSplice splice_;
  ErrorChain chain_;
  const SensorTape& tape_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_HELD_OUT_PREDICTION_H_
