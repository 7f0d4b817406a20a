#ifndef HINDSIGHT_APP_DRAFT_PLACES_H_
#define HINDSIGHT_APP_DRAFT_PLACES_H_

#include <functional>

#include "dataset/dataset.h"
#include "io/config/recording_draft.h"

namespace hindsight {

/// Where unit or order of latitude and longitude is a guess
/// (FoundStream::place_is_told) and the positions fit the IMU's motion at no
/// offset of their clock, takes what fits of radians, the other order, and both.
/// `load` gives the recording as the draft has it, nullptr if it does not load.
void TellPlaces(const std::function<const Dataset*()>& load,
                RecordingDraft* draft);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_DRAFT_PLACES_H_
