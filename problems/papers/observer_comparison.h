#ifndef HINDSIGHT_PROBLEMS_PAPERS_OBSERVER_COMPARISON_H_
#define HINDSIGHT_PROBLEMS_PAPERS_OBSERVER_COMPARISON_H_

#include <string>
#include <utility>
#include <vector>

#include "filters/forward_filter.h"
#include "problems/montecarlo.h"

namespace hindsight {

/// A forward filter to compare.
struct ObserverModel {
  std::string rule;  ///< as printed, with its parameters
  ForwardModel model;
};

/// Velocity, attitude and both biases from the given start of a data set, which
/// has an attitude with its sigmas, the position being known; preintegrated.
Problem AlignmentProblem(const Dataset& dataset);

/// One filter of such a problem. Values by name:
///   diverged, escaped, converged   0 or 1; problems/papers/attitude_limits.h
///   t_settled             first time from which tilt, the angle between true and
///                         estimated vertical, and heading, the difference of
///                         the Euler angles, stay inside kSettledAttitude;
///                         infinite if they do not at the end [s]
///   tilt, heading         at the end [rad]
///   t_escape              [s], of a run that escapes; of the others
///   backed_off, least_information   share of the steps; BoundRecord
///   v_first, v_last, v_largest   V = e' P^-1 e after the first update, at the
///                         end, at most; e is the error as the filter defines it
///   share_falling         of the steps over which V fell. Noise keeps V of a
///                         right filter fluctuating about the dimension, where
///                         half of the steps fall
///   radius_first, radius_largest   attitude error [rad], the other errors zero,
///                         inside of which V is guaranteed to fall: where the
///                         first is guaranteed, and the largest. Zero where some
///                         direction has neither noise nor information (mu = 0),
///                         as a constant bias before manoeuvres
/// With e' = (A - K C) e + phi + noise and the Riccati equation of the rule,
///   V' = -e' M e + 2 e' P^-1 phi,
///   M = P^-1 Q P^-1 + C' R^-1 C + weight L' L + alpha (S P^-1 + P^-1 S),
/// where phi is what the linearisation leaves out. To leading order
///   |phi_v| <= |f| |psi|^2 / 2 + |psi| |db_a|,   |phi_psi| <= |psi| |db_g|;
/// the left-invariant error has no first term (its navigation part is linear
/// for known biases) but |nu| |db_g| in its place. So V' <= -mu V + 2 c V^1.5,
/// mu the least eigenvalue of P^1/2 M P^1/2, and noise apart V falls wherever
/// sqrt(V) < mu / (2 c).
std::vector<std::pair<std::string, double>> RunObserver(
    const ForwardModel& model, const Dataset& dataset, Problem problem);

/// Every filter on a recording, whose nodes and preintegration are made once. A
/// node without truth is an InputError. Figures by rule and error: shares
/// diverged (escaped ones included), escaped and converged; t_escape, median;
/// of t_settled, tilt and heading the percentiles _50 and _95 over all runs,
/// escaped ones counting as infinite; of the runs that did not escape the mean
/// share of backed_off steps and the medians of the others.
Trial ObserverTrial(const std::vector<ObserverModel>& models);
StudyTable ObserverTable();

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_PAPERS_OBSERVER_COMPARISON_H_
