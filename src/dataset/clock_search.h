#ifndef HINDSIGHT_DATASET_CLOCK_SEARCH_H_
#define HINDSIGHT_DATASET_CLOCK_SEARCH_H_

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "dataset/dataset.h"

namespace hindsight {

/// An offset of a record's stamps at which its motion is that of the IMU.
struct ClockCandidate {
  double offset = 0.0;  ///< added to the stamps [s]
  double sigma = 0.0;   ///< from the curvature of the misfit [s]
  /// Sum of squared differences over the mean of what both records move, each
  /// about its mean: 0 is the same motion, 2 is none in common.
  double misfit = 0.0;
};

/// What a search over offsets found.
struct ClockSearch {
  /// The best first; empty if the records do not tell.
  std::vector<ClockCandidate> candidates;
  int left_out = 0;         ///< further ones, of which there were too many
  std::string compared;     ///< "accelerations", "turns": what was compared
  double resolution = 0.0;  ///< time over which motion was averaged [s]
  double freedom = 0.0;     ///< independent components compared
  /// As of the candidates, at any offset; infinite where too little overlaps.
  std::function<double(double offset)> misfit;
};

/// Offsets to search [s].
struct OffsetRange {
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();
};

/// The offsets at which records of [a_begin, a_end] and [b_begin, b_end], b
/// moved, overlap by at least half of the shorter.
OffsetRange OverlappingOffsets(double a_begin, double a_end, double b_begin,
                               double b_end);

/// The offsets, within `range` and OverlappingOffsets, at which the
/// measurements that are not withheld fit the IMU best. Compared are, over
/// windows of half a second or as long as it takes the noise to fall to 0.3
/// m/s^2 or 0.01 rad/s, at most 5 s:
///   position, velocity,  accelerations less gravity against the specific
///   speed and course     force in axes that the gyros hold, turned to fit
///                        (Wahba 1965) in pieces of 5 to 15 s, in which the
///                        gyros' bias turns little
///   odometer, dvl        change of the velocity, brought into those axes by
///                        the gyros, less the integral of the specific force;
///                        what is constant over a piece is gravity
///   magnetometer         change of the field, brought there by the gyros;
///                        the hard iron is free
///   height               its acceleration against the specific force, the
///                        vertical free in each piece
/// A candidate is a minimum of the misfit below a half (the quarter of what no
/// common motion leaves), of heights and of velocities in the vehicle's axes also
/// below half of the median over OverlappingOffsets (what is free in each piece of
/// these may fit any smooth motion), the lowest of those closer than the
/// resolution; at most eight, and none if chance would give the best within five
/// sigmas.
/// Nothing is compared for other types.
ClockSearch SearchClock(const ImuStream& imu, const InitialState& initial,
                        const AidingStream& stream, OffsetRange range = {});

/// The same for a truth: turns from one of its attitudes to the next, half a
/// second later or more, against those of the gyros, less the mean that a
/// constant bias leaves; the Earth's rate is allowed for where the truth has
/// positions. An attitude that turns too little to tell the clock to 20 ms
/// tells nothing.
ClockSearch SearchClock(const ImuStream& imu, const TruthSeries& truth);

/// Whether a misfit may be as low as that of the best candidate but for chance:
/// the logarithm of the ratio of two mean squares of n independent components
/// has the variance 4/n at most; by five standard deviations.
bool IsPlausible(const ClockSearch& found, double misfit);

/// Takes away the candidates that are not plausible.
void DropImplausible(ClockSearch* found);

/// One line for each stream whose clock is unknown and where more than one
/// candidate is plausible, in words; see CheckReport::warnings.
std::vector<std::string> FindAmbiguousClocks(const Dataset& dataset);

/// Gives a stream whose clock is unknown the best of `found` as its time offset
/// and the resolution as the a priori sigma of its estimate; false if nothing
/// was found.
bool TakeClock(const ClockSearch& found, AidingStream* stream);

/// What was found, in words: "-0.636 s, or 0.73 s, from
/// accelerations", with sigma and misfit of each.
std::string Describe(const ClockSearch& search);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_CLOCK_SEARCH_H_
