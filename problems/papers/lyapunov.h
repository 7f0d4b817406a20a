#ifndef HINDSIGHT_PROBLEMS_PAPERS_LYAPUNOV_H_
#define HINDSIGHT_PROBLEMS_PAPERS_LYAPUNOV_H_

#include <vector>

#include "filters/forward_filter.h"

namespace hindsight {

/// The paper's analysis of an observer by V = e' P^-1 e, as figures along a
/// simulated run. e is the error as the filter defines it, P that after the
/// update.
///
/// With e' = (A - K C) e + phi + noise and the Riccati equation of the rule,
///   V' = -e' M e + 2 e' P^-1 phi,
///   M = P^-1 Q P^-1 + C' R^-1 C + weight L' L + alpha (S P^-1 + P^-1 S),
/// where phi is what the linearisation leaves out. To leading order
///   |phi_v| <= |f| |psi|^2 / 2 + |psi| |db_a|,   |phi_psi| <= |psi| |db_g|;
/// the left-invariant error has no first term (its navigation part is linear
/// for known biases) but |nu| |db_g| in its place. So V' <= -mu V + 2 c V^1.5,
/// mu the least eigenvalue of P^1/2 M P^1/2, and noise apart V falls wherever
/// sqrt(V) < mu / (2 c).
struct LyapunovFigures {
  double v_first = 0.0;  ///< V after the first update
  double v_last = 0.0;
  double v_largest = 0.0;
  /// Share of steps over which V fell. Noise keeps V of a right filter
  /// fluctuating about the dimension, where half of the steps fall.
  double share_falling = 0.0;
  /// Share of falling steps in the first 30 s, where the error of the start is
  /// to decay.
  double share_falling_early = 0.0;
  /// Least and largest eigenvalue of P over the run, each component counted in
  /// its a priori standard deviation.
  double p_least = 0.0;
  double p_largest = 0.0;
  /// Attitude error [rad], the other errors zero, inside of which V is
  /// guaranteed to fall: after the first step, and the largest over the run.
  /// Zero where some direction has neither noise nor information (mu = 0), as
  /// a constant bias before manoeuvres.
  double radius_first = 0.0;
  double radius_largest = 0.0;
};

/// Figures of a run. `truth` at the tape's epochs; `timeline` as filtered;
/// eigenvalues and radii are taken once a second.
LyapunovFigures AnalyseRun(const LinearTape& tape, const ForwardModel& model,
                           const Timeline& timeline,
                           const std::vector<State>& truth);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_PAPERS_LYAPUNOV_H_
