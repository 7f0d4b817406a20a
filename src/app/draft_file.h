#ifndef HINDSIGHT_APP_DRAFT_FILE_H_
#define HINDSIGHT_APP_DRAFT_FILE_H_

#include <string>

#include "io/config/recording_draft.h"

namespace hindsight {

/// Writes a draft's text to a file, whole or not at all; --force replaces what
/// 'init' wrote. Throws as AtomicFile does.
void WriteDraft(const std::string& path, const std::string& text);

/// Throws OutputError where a draft of that name could not be written.
void RequireRoomFor(const std::string& path);

/// Says on standard output which files, rows and columns of the recording were not
/// recognised, ten of them in a line each.
void PrintLeftOut(const RecordingDraft& draft);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_DRAFT_FILE_H_
