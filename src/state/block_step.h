#ifndef HINDSIGHT_STATE_BLOCK_STEP_H_
#define HINDSIGHT_STATE_BLOCK_STEP_H_

#include <cmath>
#include <optional>

#include "state/error_layout.h"

namespace hindsight {

/// How a block b beyond the navigation state goes through one interval of
/// length dt, an axis:
///   b_j = phi b_i + r_i share dt + w,   w ~ (0, variance),
/// r being the block `rate`, as far as there is one, which acts for `rate_share` of dt.
struct BlockStep {
  BlockKey key;
  double phi = 1.0;
  double variance = 0.0;
  std::optional<BlockKey> rate = std::nullopt;
  double rate_share = 1.0;  ///< beyond 1 where it began before the interval
  double down = 1.0;  ///< sigma of w in the third axis, by that of the others

  double VarianceOf(int axis) const {
    return axis == 2 ? down * down * variance : variance;
  }
};

/// As the block's evolution says; `distance` travelled in dt [m] for those that
/// change with it.
inline BlockStep EvolutionStep(const Block& block, double dt, double distance) {
  return {block.key, block.evolution.Phi(dt, distance),
          block.evolution.Q(dt, distance)};
}

/// The first part of a step, 0 < part <= 1 of its time: so many equal parts one
/// after the other make up the whole. What is drawn anew (phi = 0) is so from
/// the begin.
inline BlockStep PartOf(BlockStep step, double part) {
  if (part >= 1.0) return step;
  if (step.phi == 1.0) {
    step.variance *= part;
  } else if (step.phi > 0.0) {
    const double whole = 1.0 - step.phi * step.phi;
    step.phi = std::pow(step.phi, part);
    step.variance *= (1.0 - step.phi * step.phi) / whole;
  }
  return step;
}

}  // namespace hindsight

#endif  // HINDSIGHT_STATE_BLOCK_STEP_H_
