#ifndef HINDSIGHT_IO_CONFIG_DRAFT_VALUES_H_
#define HINDSIGHT_IO_CONFIG_DRAFT_VALUES_H_

#include "io/config/recording_draft.h"

namespace hindsight {

/// Adds to a drafted stream the usual values of what its file does not say, so
/// that it loads as it stands; each says that it is a guess. `axes_known`: the
/// IMU's axes have been told.
void CompleteStream(bool axes_known, StreamDraft* stream);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_DRAFT_VALUES_H_
