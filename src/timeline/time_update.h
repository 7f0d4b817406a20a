#ifndef HINDSIGHT_TIMELINE_TIME_UPDATE_H_
#define HINDSIGHT_TIMELINE_TIME_UPDATE_H_

#include "imu/imu_link.h"
#include "state/block_step.h"
#include "timeline/timeline.h"

namespace hindsight {

/// The interval of a timeline from node k to the next, or a part of it: what
/// `summary` covers.
struct NodeInterval {
  const Timeline& timeline;
  std::size_t k = 0;
  const ImuSummary& summary;
  bool with_velocity_steps = true;  ///< of the timeline
};

/// The whole interval after node k, its summary integrated at the calibration
/// of x or near enough (Timeline::Integrate).
NodeInterval IntervalAfter(std::size_t k, const ErrorLayout& layout,
                           const State& x, Timeline* timeline);

/// How a block beyond the navigation state goes through the interval: as the
/// timeline says, else by its evolution. `distance`: Travelled in it [m].
BlockStep StepOf(const NodeInterval& interval, const Block& block,
                 double distance);

/// LinkNoise of the summary, with the steps of the velocity that the timeline has there:
/// an axis alike, so in whatever axes.
ImuLink::Matrix15 LinkNoise(const NodeInterval& interval);

/// The one time update: the state at the end of the interval that follows from
/// x_i at its begin. The navigation state is predicted by the IMU, biases and
/// parameters go on as their evolutions or the timeline's steps say, and
/// travelled distances grow (timeline/distance_link.h).
State Advance(const ErrorLayout& layout, const NodeInterval& interval,
              const State& x_i);

/// As Advance, but with the navigation state of `navigation` at the end: for
/// several models about one navigation nominal.
State AdvanceBeside(const State& navigation, const ErrorLayout& layout,
                    const NodeInterval& interval, const State& x_i);

/// Linearises the update at x_i and x_j,
///   d_j = Phi d_i + c + w,   w ~ (0, Q).
/// c is zero but for rounding if x_j = Advance(x_i).
void LinearizeAdvance(const ErrorLayout& layout, const NodeInterval& interval,
                      const State& x_i, const State& x_j, Transition* out);

}  // namespace hindsight

#endif  // HINDSIGHT_TIMELINE_TIME_UPDATE_H_
