#ifndef HINDSIGHT_DATASET_REST_H_
#define HINDSIGHT_DATASET_REST_H_

#include <mutex>
#include <optional>
#include <vector>

#include "dataset/dataset.h"
#include "dataset/time_interval.h"

namespace hindsight {

/// Where a vehicle is at rest: two decisions, of which an IMU can make the
/// first alone. Each list is in time order and none overlaps another.
struct Rest {
  /// It does not turn and does not move.
  std::vector<TimeInterval> at_rest = {};
  /// It does not turn, and moves smoothly and straight on.
  std::vector<TimeInterval> moving = {};
  /// It does not turn; whether it moves, nothing says.
  std::vector<TimeInterval> undecided = {};
  /// Quiet, but the mean rate contradicts that of other rests: either here or
  /// there the vehicle turns steadily (LeaveOutTurned).
  std::vector<TimeInterval> turning = {};
};

/// Decides by IMU and aiding. Not turning: ExamineImu. Not moving: only where
/// measurements exclude motion, horizontally to kKnownSpeed, one sigma, none of
/// them against it by more than four sigmas and twice
/// StationaryOptions::velocity_sigma on any axis, nor all of a span or part of
/// it together (LeaveOutContradicted); and, while nothing shakes the IMU, as
/// long before and after as the speed that it has gathered since stays within
/// its noise, and the uncertainty of carrying it (noise, bias walk, and how
/// well the reading at rest is known) within kKnownSpeed. Where the mean
/// specific force of the end of a rest differs from the one before so that it
/// brings more than kKnownSpeed and four sigmas, that end is none, unless
/// aiding excludes the way it would make. A horizontal or vertical speed above
/// 0.3 m/s and five sigmas is motion, a second before and after its middle as
/// well. What idles shaken is at rest where aiding says so for 3 s, half a
/// second at each end left out. Of rests whose rates contradict each other
/// LeaveOutTurned decides. Spans that are shaken or turn are in none of
/// the lists.
Rest FindRest(const Dataset& dataset);

/// FindRest of one data set, found once for all who ask while nobody changes it.
class RestMemo {
 public:
  /// `dataset` must outlive the object.
  explicit RestMemo(const Dataset& dataset) : dataset_(dataset) {}

  /// Of another data set it is found anew. Any thread may ask.
  Rest Of(const Dataset& dataset) const;

 private:
  const Dataset& dataset_;
  mutable std::mutex mutex_;
  mutable std::optional<Rest> found_;
};

/// The rest that begins at t, or within a second after, from t on; the last if
/// there are several.
std::optional<TimeInterval> RestFrom(double t,
                                     const std::vector<TimeInterval>& rests);

/// Moves to `undecided` those parts of the rests that aiding contradicts
/// (ExcludedMotion::Cut).
void LeaveOutContradicted(const Dataset& dataset, Rest* rest);

/// Sum of the lengths [s].
double TotalLength(const std::vector<TimeInterval>& spans);

/// Adds the streams "zero_velocity" and "zero_angular_rate": over each span at
/// rest a measurement of each in every window (of at most 1 s), with the sigmas
/// of StationaryOptions; the velocities of a rest of n windows not less than
/// sqrt(n) times the speed that aiding leaves possible over it
/// (ExcludedMotion::PossibleSpeed), so that together they are no surer than it.
/// What rests by estimate while aiding is silent is taken as known to
/// kKnownSpeed; without any aiding the sigma is that of StationaryOptions. Over
/// the other spans, in which it does not turn, zero angular rates where the
/// bias is known to rate_sigma, from a rest or as given, and the mean reading
/// agrees with it to three sigmas; a span of n windows counts as one reading
/// (sigma times sqrt(n)), for a turn too slow to be told lasts as long as it
/// does. Streams of these names must not be there.
void AddRestStreams(const Rest& rest, Dataset* dataset);

/// The windows of a span, each of which holds one measurement.
std::vector<TimeInterval> WindowsOf(const TimeInterval& span,
                                    const StationaryOptions& options);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_REST_H_
