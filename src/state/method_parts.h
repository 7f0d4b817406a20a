#ifndef HINDSIGHT_STATE_METHOD_PARTS_H_
#define HINDSIGHT_STATE_METHOD_PARTS_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "state/filter_separation.h"

namespace hindsight {

/// What methods of one kind tell beside what every solution has. Series are as
/// long as the solution's states, unless it is said otherwise.

/// Of smoothers that fuse a forward with a backward filter.
struct TwoFilterPart {
  /// Distance of the forward position from that of the backward filter alone,
  /// in sigmas of their difference: sqrt(e' (P_f + P_b)^-1 e), whose square is
  /// chi-square with three degrees of freedom if models and noise are right.
  /// NaN where the backward filter has no position yet; empty for a layout
  /// without positions.
  std::vector<double> separation;
  /// The separation of each component at each epoch.
  std::vector<FilterSeparation> components;
  /// The backward filter alone, at some of the epochs, evenly.
  std::vector<OneSidedState> backward;
};

/// Of multiple-model methods.
struct ModePart {
  std::vector<std::string> names;
  std::vector<Eigen::VectorXd> probabilities;  ///< of each mode
};

/// Of filters of attitude alone: what became of their readings.
struct AttitudePart {
  /// R in force of the accelerometer as a standard deviation, infinity where it
  /// was not used [m/s^2].
  std::vector<double> accel_sigma;
  /// 1 where the field was used, 0 without a reading, -1 where it was taken for
  /// disturbed.
  std::vector<signed char> magnetic;
};

/// Of forward observers: their Riccati equation and how it fared.
struct ObserverFigures {
  double gamma = 0.0;  ///< of H-infinity [sqrt(s)]; 0: of another rule
  double alpha = 0.0;  ///< [1/s]
  double delta = 0.0;  ///< [1/s]
  int steps = 0;
  int back_offs = 0;  ///< steps without gamma or delta
  /// Smallest share of the information on L x that the weight of L' L left at
  /// any step it was in force; 0 is the escape.
  double least_information = 1.0;
};

}  // namespace hindsight

#endif  // HINDSIGHT_STATE_METHOD_PARTS_H_
