#ifndef HINDSIGHT_PROBLEMS_OBSERVER_COMPARISON_H_
#define HINDSIGHT_PROBLEMS_OBSERVER_COMPARISON_H_

#include <functional>
#include <string>
#include <vector>

#include "dataset/dataset.h"
#include "problems/lyapunov.h"
#include "problems/montecarlo.h"

namespace hindsight {

/// A forward filter to compare.
struct ObserverModel {
  std::string rule;  ///< as printed, with its parameters
  ForwardModel model;
};

/// A cell's start: puts the initial values of a seed into its data set.
struct ObserverStart {
  std::string name;
  std::function<void(std::uint64_t seed, Dataset* dataset)> apply;
};

/// Recordings that differ in their seed alone, truth at every node.
struct ObserverRecording {
  std::string name;
  std::function<Dataset(std::uint64_t seed)> dataset;
};

/// What one filter made of one run. Tilt is the angle between true and
/// estimated vertical, heading the difference of the Euler angles.
struct ObserverRun {
  bool escaped = false;
  double t_escape = 0.0;  ///< [s]
  bool diverged = false;
  /// First time from which tilt and heading stay inside the settled limits;
  /// infinite if they do not at the end [s].
  double t_settled = 0.0;
  double tilt = 0.0;               ///< at the end [rad]
  double heading = 0.0;            ///< at the end, absolute [rad]
  double backed_off = 0.0;         ///< share of the steps, of BoundRecord
  double least_information = 1.0;  ///< of BoundRecord
  LyapunovFigures lyapunov;
};

struct ObserverLimits {
  double settled_tilt = 0.0;      ///< [rad]
  double settled_heading = 0.0;   ///< [rad]
  double diverged_tilt = 0.0;     ///< exceeded in the last ... [rad]
  double diverged_heading = 0.0;  ///< ... or [rad]
  double last = 0.0;              ///< ... so many seconds
};

/// One recording, start and filter over all seeds. Percentiles are over all
/// runs, escaped ones counting as infinite.
struct ObserverCell {
  std::string recording, start, rule;
  ErrorDefinition error = ErrorDefinition::kNavigation;
  int runs = 0;
  int diverged = 0;  ///< escaped ones included
  int escaped = 0;
  double t_escape = 0.0;  ///< median of those that escaped [s]
  int converged = 0;      ///< settled at the end
  double t_settled_50 = 0.0, t_settled_95 = 0.0;  ///< [s]
  double tilt_50 = 0.0, tilt_95 = 0.0;            ///< at the end [rad]
  double heading_50 = 0.0, heading_95 = 0.0;      ///< at the end [rad]
  /// Mean share of the steps backed off and median of the least information
  /// left, of the runs that did not escape.
  double backed_off = 0.0;
  double least_information = 1.0;
  /// Medians of the runs that did not escape; extremes of the eigenvalues.
  LyapunovFigures lyapunov;
};

/// Velocity, attitude and both biases, the position being known; a priori
/// covariances and evolutions as the data set's initial values and IMU say. It
/// must give velocity, attitude and their sigmas.
ErrorLayout AlignmentLayout(const Dataset& dataset);

/// One filter on one recording.
ObserverRun RunObserver(const ForwardModel& model, const Dataset& dataset,
                        const ObserverLimits& limits, Timeline* timeline);

/// Every filter from every start of every recording, on common seeds. The
/// recording, its nodes and its preintegration are made once a seed. The result
/// is the same to the last bit whatever the number of threads and whichever
/// cells are left out. Empty where no run is finished. Throws InputError if a
/// node has no truth.
std::vector<ObserverCell> CompareObservers(
    const std::vector<ObserverRecording>& recordings,
    const std::vector<ObserverStart>& starts,
    const std::vector<ObserverModel>& models, const ObserverLimits& limits,
    const MonteCarloOptions& options,
    const Watch<std::vector<ObserverCell>>& watch = {});

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_OBSERVER_COMPARISON_H_
