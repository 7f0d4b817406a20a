#ifndef HINDSIGHT_IO_CONFIG_RECORDING_GROUPS_H_
#define HINDSIGHT_IO_CONFIG_RECORDING_GROUPS_H_

#include <vector>

#include "io/config/recording_search.h"

namespace hindsight {

/// The recordings of which the files lie in one folder, told by IMUs that are on
/// no wheel: two whose records have no instant in common are of two recordings if
/// every other stream overlaps one by at least half of the shorter, or all have
/// dates; else two are if their names differ by words (a day, a number), of which
/// the names of other streams hold those of one each, in two recordings at least.
/// A stream that fits several by its times is in each. What fits none stands among
/// the `copies` of all, with the reason. One recording if neither tells.
std::vector<RecordingFiles> GroupRecordings(RecordingFiles files);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_RECORDING_GROUPS_H_
