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
  EpochCallback callback;
};

struct IteratedResult {
  SmoothedTrajectory trajectory;
  int iterations = 0;
  /// Stopped by the tolerances, or out of iterations with a last step of less
  /// than a hundredth of a standard deviation everywhere.
  bool converged = false;
};

/// A step this small, in standard deviations, changes no conclusion.
inline constexpr double kSettledStep = 0.01;

/// Largest difference of two trajectories in a component of position or
/// attitude, in its standard deviations.
double LargestMoveInSigmas(const ErrorLayout& layout,
                           const std::vector<State>& from,
                           const std::vector<State>& to,
                           const CovarianceSeries& P);

/// Iterated RTS smoother: Gauss-Newton on the whole interval. Each pass runs
/// the linearised filter and the RTS smoother about the trajectory of the pass
/// before (Bell 1994), starting from `nominal`.
IteratedResult SmoothIterated(const ErrorLayout& layout, const Prior& prior,
                              std::vector<State> nominal, Timeline* timeline,
                              const GateDecisions& decisions,
                              const IterationOptions& options);

/// Gate decisions about a smoothed trajectory: each measurement is tested by
/// its residual with the covariance it has when the measurement itself is left
/// out, R - H P H' scaled back if `used` says that it took part in the
/// smoothing and R + H P H' if not. Withheld ones are never used.
GateDecisions DecideGates(const ErrorLayout& layout, const Timeline& timeline,
                          const SmoothedTrajectory& trajectory,
                          const GateDecisions& used);

/// The decisions that a forward pass recorded on its tape.
GateDecisions DecisionsOnTape(const LinearTape& tape);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_ITERATED_SMOOTHER_H_
