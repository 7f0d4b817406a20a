#ifndef HINDSIGHT_RECEIVER_ERRORS_SEQUENCE_SMOOTHER_H_
#define HINDSIGHT_RECEIVER_ERRORS_SEQUENCE_SMOOTHER_H_

#include <Eigen/Core>
#include <cstddef>

#include "receiver_errors/mode_sequence.h"

namespace hindsight {

/// How well a sequence explains the measurements of a tape.
struct SequenceScore {
  double log_likelihood = 0.0;  ///< of all measurements, given the sequence
  double log_prior = 0.0;       ///< of the sequence
  double log_posterior() const { return log_likelihood + log_prior; }
};
SequenceScore ScoreSequence(const SensorTape& tape,
                            const ErrorParameters& parameters,
                            const ModeSequence& sequence);

/// Errors (navigation, e, r) about a tape's nominal, by node, in no more memory than
/// they need.
class ErrorTrajectory {
 public:
  ErrorTrajectory() = default;
  ErrorTrajectory(int dim, std::size_t nodes)
      : errors_(dim, static_cast<Eigen::Index>(nodes)) {}

  std::size_t size() const { return static_cast<std::size_t>(errors_.cols()); }
  auto operator[](std::size_t k) {
    return errors_.col(static_cast<Eigen::Index>(k));
  }
  auto operator[](std::size_t k) const {
    return errors_.col(static_cast<Eigen::Index>(k));
  }
  auto front() const { return errors_.col(0); }

 private:
  Eigen::MatrixXd errors_;
};

/// Smoothed means. Bryson and Frazier's form (as in Bierman 1973), which needs no inverse
/// of a covariance: e and r are known exactly where the receiver is good.
ErrorTrajectory SmoothSequence(const SensorTape& tape,
                               const ErrorParameters& parameters,
                               const ModeSequence& sequence);

/// Mean square of the horizontal distances of two trajectories [m^2].
double MeanSquareDistance(const ErrorTrajectory& a, const ErrorTrajectory& b);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_SEQUENCE_SMOOTHER_H_
