#ifndef HINDSIGHT_STATE_FILTER_SEPARATION_H_
#define HINDSIGHT_STATE_FILTER_SEPARATION_H_

#include <Eigen/Core>

#include "state/state.h"

namespace hindsight {

/// Forward minus backward estimate of one epoch, of a forward filter that has
/// the epoch's measurements and a backward filter that has not: what the two
/// know is independent. Components are position north, east, down [m], velocity
/// north, east, down [m/s], roll, pitch, heading [rad]; NaN where the layout has
/// none or the backward filter knows nothing.
struct FilterSeparation {
  static constexpr int kComponents = 9;
  using Components = Eigen::Matrix<double, kComponents, 1>;

  Components difference;
  Components sigma;  ///< sqrt(P_f + P_b)
};

/// What one side alone knows at an epoch.
struct OneSidedState {
  State state;
  /// Standard deviations over the layout; NaN where nothing is known.
  ErrorVector sigma;
};

}  // namespace hindsight

#endif  // HINDSIGHT_STATE_FILTER_SEPARATION_H_
