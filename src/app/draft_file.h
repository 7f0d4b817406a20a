#ifndef HINDSIGHT_APP_DRAFT_FILE_H_
#define HINDSIGHT_APP_DRAFT_FILE_H_

#include <string>

namespace hindsight {

/// Writes a draft's text to a file, whole or not at all; --force replaces what
/// 'init' wrote. Throws as AtomicFile does.
void WriteDraft(const std::string& path, const std::string& text);

/// Throws OutputError where a draft of that name could not be written.
void RequireRoomFor(const std::string& path);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_DRAFT_FILE_H_
