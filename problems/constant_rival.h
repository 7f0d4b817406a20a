#ifndef HINDSIGHT_PROBLEMS_CONSTANT_RIVAL_H_
#define HINDSIGHT_PROBLEMS_CONSTANT_RIVAL_H_

#include <optional>
#include <string>
#include <vector>

#include "filters/forward_filter.h"
#include "timeline/problem.h"

namespace hindsight {

/// A constant that the problem does not estimate, and that explains what looks like
/// errors of sensors: of the IMU (ImuDeviations), or of an odometer, a DVL or another
/// sensor in the axes of the vehicle what its kind may estimate (scale, mounting, lever
/// arm, clock).
struct ConstantRival {
  std::string what;  ///< a clause: "gyro z measures 1.00 % too much"
  /// ln of the evidence that it gains: z^2 / 2, what the likelihood is larger by at its
  /// likeliest size (DeviationColumns::ZOf), less odds of a thousand in place of a prior
  /// of its size.
  double log_gain = 0.0;
};

/// The likeliest, in the problem linearised about `nominal`, a state a node; none if
/// there is nothing of the kind.
std::optional<ConstantRival> LikeliestConstant(
    Problem problem, const std::vector<State>& nominal,
    const EpochCallback& callback = nullptr);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_CONSTANT_RIVAL_H_
