#ifndef HINDSIGHT_IO_CONFIG_RECORDING_GROUPS_H_
#define HINDSIGHT_IO_CONFIG_RECORDING_GROUPS_H_

#include <vector>

#include "io/config/recording_search.h"

namespace hindsight {

/// The recordings of which the files lie in one folder, told by IMUs that are on
/// no wheel: by their times, if these are dates and no two of them have an instant
/// in common; then a dated stream is of each that it overlaps by at least half of
/// the shorter, and another of that whose name it shares a word with that no other
/// IMU's has. Else by such words alone (a day, a number), if they place streams in
/// two recordings at least, and none in two. What fits none stands among the
/// `copies` of all, with the reason. One recording if neither tells; throws
/// InputError if it is none: IMUs that recorded for different times (by 5 % and
/// more), with positions in as many files.
std::vector<RecordingFiles> GroupRecordings(RecordingFiles files);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_RECORDING_GROUPS_H_
