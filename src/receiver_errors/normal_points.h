#ifndef HINDSIGHT_RECEIVER_ERRORS_NORMAL_POINTS_H_
#define HINDSIGHT_RECEIVER_ERRORS_NORMAL_POINTS_H_

#include <cstddef>
#include <optional>
#include <vector>

#include "filters/linear_tape.h"
#include "receiver_errors/mode_sequence.h"

namespace hindsight {

/// A tape with one node in each `interval`, for fixes that come faster than the
/// errors of a receiver change. The measurements of an interval are carried to
/// the node in its middle by the tape's transitions,
///   x_i = F x + d + w, w ~ (0, Q):   r - H d = (H F) x + (H w + v),
/// and those of a sensor with as many rows each are averaged there, weighed by
/// 1 / tr(R): normal points, as satellite laser ranging calls them. Any average
/// of measurements is a measurement, so that nothing is made up; what is lost is
/// what the measurements of one interval say of changes within it, and that the
/// process noise of the interval is common to several (it is counted in each
/// sensor's own R). A fix of the sensor that is searched for errors which lies
/// more than five sigmas from the median of its interval on any axis is left out
/// of the average, unless half of them do.
struct NormalPoints {
  LinearTape tape;
  /// By fix of the sensor on the full tape, in order: the fix on this one.
  std::vector<std::size_t> point_of_fix;
};

/// Errors of receivers - multipath, filters, satellites that come and go -
/// change over seconds [s].
inline constexpr double kNormalPointInterval = 1.0;

/// Of a sensor of positions: a second, or less where a recording has fewer than 1200 of
/// these intervals, half a second at the least [s]. A jump stands out against what the
/// IMU leaves open from one point to the next, which grows with their distance. Fixes
/// that a receiver has smoothed are alike over less, and look as if they had no noise.
double NormalPointInterval(const LinearTape& tape);

/// None where fixes of the sensor are not closer than that: where normal points
/// would be more than two thirds of the fixes.
std::optional<NormalPoints> FormNormalPoints(
    const LinearTape& tape, int sensor, double interval = kNormalPointInterval);

/// All fixes of the sensor, each at its node, to which what others measured is carried
/// as NormalPoints are, from nodes that are nearest to it and half an `interval` away
/// at the most; where there are no fixes, a node an interval. None where that would be
/// more than two thirds of the nodes.
std::optional<LinearTape> ThinBetweenFixes(
    const LinearTape& tape, int sensor, double interval = kNormalPointInterval);

/// A sequence over normal points as one over the fixes: what is new at a point
/// is so at its first fix.
ModeSequence AtFixes(const NormalPoints& points, const ModeSequence& sequence);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_NORMAL_POINTS_H_
