#ifndef HINDSIGHT_FILTERS_ITERATED_SMOOTHER_H_
#define HINDSIGHT_FILTERS_ITERATED_SMOOTHER_H_

#include "filters/forward_filter.h"
#include "filters/rts.h"

namespace hindsight {

struct IterationOptions {
  int max_iterations = 20;
  /// Stops when no node moves farther than this.
  double position_tolerance = 1e-5;  ///< [m]
  double attitude_tolerance = 1e-8;  ///< [rad]
  /// Rough covariances of the result, an epoch each: if given, the iteration
  /// ends as soon as what is left of it changes no conclusion, and the result
  /// has no covariances of its own. It then stops when the steps still to come,
  /// if they go on shrinking as the last ones did, add up to less than
  /// kNegligibleRest of these sigmas in every component of position and
  /// attitude.
  const CovarianceSeries* rough = nullptr;
  EpochCallback callback;
};

struct IteratedResult {
  SmoothedTrajectory trajectory;
  int iterations = 0;
  /// Stopped by the tolerances, or out of iterations with a last step of less
  /// than a hundredth of a standard deviation everywhere.
  bool converged = false;
  /// Of the accepted measurements, linearised about the trajectory before the
  /// last step.
  double log_likelihood = 0.0;
  /// Mean normalised squared innovation of a row, likewise; 1 if models and
  /// noise are right.
  double nis = 0.0;
};

/// A step this small, in standard deviations, changes no conclusion.
inline constexpr double kSettledStep = 0.01;

/// The sum of steps to come that is as good as none [standard deviations].
inline constexpr double kNegligibleRest = 0.003;

/// Largest difference of two trajectories in a component of position or
/// attitude, in its standard deviations.
double LargestMoveInSigmas(const ErrorLayout& layout,
                           const std::vector<State>& from,
                           const std::vector<State>& to,
                           const CovarianceSeries& P);

/// Iterated RTS smoother: Gauss-Newton on the whole interval. Each pass runs
/// the linearised filter and the RTS smoother about the trajectory of the pass
/// before (Bell 1994), starting from `nominal`.
IteratedResult SmoothIterated(std::vector<State> nominal,
                              const IterationOptions& options,
                              Problem* problem);

/// ln of the likelihood of the accepted measurements of a tape, by its innovations.
double LogLikelihoodOf(const LinearTape& tape);

/// LogLikelihoodOf a linearised filter about the trajectory that smoothing again and
/// again leads to: of the first pass, or the fourth, whose likelihood is within 0.01
/// of the one before. Costs neither covariances nor a last step back.
double SettledLogLikelihood(std::vector<State> nominal, Problem* problem);

/// Gate decisions about a smoothed trajectory: each measurement is tested by
/// its residual with the covariance it has when the measurement itself is left
/// out, R - H P H' scaled back if the problem's decisions say that it took part
/// in the smoothing and R + H P H' if not. Withheld ones are never used.
GateDecisions DecideGates(const Problem& problem,
                          const SmoothedTrajectory& trajectory);

/// The decisions that a forward pass recorded on its tape.
GateDecisions DecisionsOnTape(const LinearTape& tape);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_ITERATED_SMOOTHER_H_
