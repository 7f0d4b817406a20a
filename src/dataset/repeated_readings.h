#ifndef HINDSIGHT_DATASET_REPEATED_READINGS_H_
#define HINDSIGHT_DATASET_REPEATED_READINGS_H_

#include <string>
#include <vector>

#include "dataset/dataset.h"
#include "state/evidence.h"

namespace hindsight {

/// Readings in a row that are equal in every digit.
struct RepeatedRun {
  double t_begin = 0.0;
  double t_end = 0.0;
  long rows = 0;
};

/// Runs of an IMU's samples too long for its resolution. Coarse readings repeat
/// as well; each repetition is then followed by another with a probability that
/// the shorter runs of the stream tell, and a run that had a chance of less
/// than one in a million of coming up anywhere is none of these. At least 0.1 s
/// long.
std::vector<RepeatedRun> FindFrozenImu(const ImuStream& imu);

/// Share of a stream's rows that repeat the row before in every digit although
/// the vehicle moves: a coordinate of the readings on
/// both sides of the run is more than four steps of its resolution away, and
/// runs of the kind are the stream's habit: no longer than twice their median.
/// A receiver that holds its position at rest does not count. 0 for streams
/// that read nothing: non-holonomic, zero velocity, bearings alone.
double StaleShare(const AidingStream& stream);

/// What the recording's own repetitions say about any solution of [from, to].
///   Frozen IMU, or a stream that repeats its row longer than its shorter
///   repetitions let chance explain and then jumps by at least half of what it
///   usually changes over as many rows: doubtful. A speed of zero is rest.
///   Stale rows, a share s of all: each reading is counted 1/(1 - s) times, so
///   that its sigma is too small by 1/sqrt(1 - s). Doubtful from s = 1/2 on, a
///   factor of 1.4; not usable from 8/9 on, a factor of three.
std::vector<Evidence> FindRepeatedReadings(const Dataset& dataset, double from,
                                           double to);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_REPEATED_READINGS_H_
