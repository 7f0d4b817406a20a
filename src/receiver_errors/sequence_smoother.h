#ifndef HINDSIGHT_RECEIVER_ERRORS_SEQUENCE_SMOOTHER_H_
#define HINDSIGHT_RECEIVER_ERRORS_SEQUENCE_SMOOTHER_H_

#include "receiver_errors/mode_sequence.h"

namespace hindsight {

/// How well a sequence explains the measurements of a tape.
struct SequenceScore {
  double log_likelihood = 0.0;  ///< of all measurements, given the sequence
  double log_prior = 0.0;       ///< of the sequence
};
SequenceScore ScoreSequence(const LinearTape& tape, int receiver,
                            const ErrorParameters& parameters,
                            const ModeSequence& sequence);

/// Smoothed means of the errors (navigation, e, r) about the tape's nominal, by
/// node. Bryson and Frazier's form (as in Bierman 1973), which needs no inverse
/// of a covariance: e and r are known exactly where the receiver is good.
std::vector<ErrorVector> SmoothSequence(const LinearTape& tape, int receiver,
                                        const ErrorParameters& parameters,
                                        const ModeSequence& sequence);

/// Mean square of the horizontal distances of two trajectories so given [m^2].
double MeanSquareDistance(const std::vector<ErrorVector>& a,
                          const std::vector<ErrorVector>& b);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_SEQUENCE_SMOOTHER_H_
