#ifndef HINDSIGHT_IO_CONFIG_UNUSED_ROWS_H_
#define HINDSIGHT_IO_CONFIG_UNUSED_ROWS_H_

#include <string>
#include <vector>

#include "io/config/recording_draft.h"

namespace hindsight {

/// Of each text from whose rows of some words a draft makes streams
/// (ReadTypedColumns), the words from which it makes none: "log.txt, rows of BARO,
/// ATT".
std::vector<std::string> UnusedRows(const RecordingDraft& draft);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_UNUSED_ROWS_H_
