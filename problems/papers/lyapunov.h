#ifndef HINDSIGHT_PROBLEMS_PAPERS_LYAPUNOV_H_
#define HINDSIGHT_PROBLEMS_PAPERS_LYAPUNOV_H_

#include <string>
#include <utility>
#include <vector>

#include "filters/forward_filter.h"

namespace hindsight {

/// Of one run, by name, as RunRecord has them.
using RunValues = std::vector<std::pair<std::string, double>>;

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
///
/// Values of a run, `truth` being at the tape's epochs and `timeline` as
/// filtered; eigenvalues and radii are taken once a second:
///   v_first, v_last, v_largest   V after the first update, at the end, at most
///   share_falling         of the steps over which V fell. Noise keeps V of a
///                         right filter fluctuating about the dimension, where
///                         half of the steps fall
///   share_falling_early   the same of the first 30 s, where the error of the
///                         start is to decay
///   p_least, p_largest    eigenvalues of P over the run, each component counted
///                         in its a priori standard deviation
///   radius_first, radius_largest   attitude error [rad], the other errors zero,
///                         inside of which V is guaranteed to fall: where the
///                         first is guaranteed, and the largest. Zero where some
///                         direction has neither noise nor information (mu = 0),
///                         as a constant bias before manoeuvres
RunValues AnalyseRun(const LinearTape& tape, const ForwardModel& model,
                     const Timeline& timeline, const std::vector<State>& truth);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_PAPERS_LYAPUNOV_H_
