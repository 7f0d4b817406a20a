#ifndef HINDSIGHT_IO_CONFIG_UNUSED_COLUMNS_H_
#define HINDSIGHT_IO_CONFIG_UNUSED_COLUMNS_H_

#include <string>
#include <vector>

#include "io/config/recording_draft.h"

namespace hindsight {

/// Of each text of columns of which a draft uses some, or could, the others that look
/// measured, by their titles or numbers: "imu.csv, columns temperature, 9". Left out
/// are text, what does not change, has two values, or counts, and what titles call
/// a time, a quality or a sigma. A long file is known by its first 200 000 lines.
std::vector<std::string> UnusedColumns(const RecordingDraft& draft);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_UNUSED_COLUMNS_H_
