#ifndef HINDSIGHT_DATASET_REPEATED_READINGS_H_
#define HINDSIGHT_DATASET_REPEATED_READINGS_H_

#include <string>
#include <vector>

#include "dataset/dataset.h"
#include "dataset/frozen_imu.h"
#include "state/evidence.h"

namespace hindsight {

/// Share of a stream's rows, those of its first and last reading left out,
/// that repeat the row before in every digit although the vehicle moves: a
/// coordinate of the readings on both sides of the run is more than four steps
/// of its resolution away, and runs of the kind are the stream's habit: no
/// longer than twice their median. A receiver that holds its position at rest
/// does not count. 0 for streams that read nothing: non-holonomic, zero
/// velocity, bearings alone.
double StaleShare(const AidingStream& stream);

/// What the recording's own repetitions say about any solution of [from, to].
///   Frozen IMU (FindFrozenImu), or a stream that repeats its row longer than
///   its shorter repetitions let chance explain and then jumps by at least half
///   of what it usually changes over as many rows: doubtful. A speed of zero is
///   rest. Chance explains no run of
///     positions, two rows and more, whose jump d over the interval dt to the
///     next row is more than 5 sqrt(2) sigmas beyond 5 m/s^2 dt^2, the way of
///     a vehicle at rest that starts with 10 m/s^2: it was under way;
///     readings that else change by more than four steps of their resolution
///     from row to row, four rows and 0.1 s and more, if repeating row by row
///     as often as elsewhere makes it once in a million recordings.
///   Where stale rows, below, are told, runs of their kind are not told again.
///   Stale rows, a share s of all: each reading is counted 1/(1 - s) times, so
///   that its sigma is too small by 1/sqrt(1 - s). Doubtful from s = 1/2 on, a
///   factor of 1.4; not usable from 8/9 on, a factor of three.
std::vector<Evidence> FindRepeatedReadings(const Dataset& dataset, double from,
                                           double to);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_REPEATED_READINGS_H_
