#ifndef HINDSIGHT_IO_CONFIG_INIT_CONFIG_H_
#define HINDSIGHT_IO_CONFIG_INIT_CONFIG_H_

#include <string>

#include "io/config/recording_draft.h"

namespace hindsight {

/// The draft as a commented configuration that loads as it stands. Every guess
/// stands there with its reason and how sure it is; files that were not
/// recognised, and streams that are not used, are named in comments. `folder:`
/// is an absolute path. What was taken for granted is the list `unconfirmed`.
std::string DraftText(const RecordingDraft& draft);

/// Whether the file is what DraftText wrote, and nobody has changed it since:
/// its first line holds a checksum of the others. Throws InputError if it
/// cannot be read.
bool IsInitConfig(const std::string& path);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_INIT_CONFIG_H_
