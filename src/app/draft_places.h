#ifndef HINDSIGHT_APP_DRAFT_PLACES_H_
#define HINDSIGHT_APP_DRAFT_PLACES_H_

#include <functional>

#include "dataset/dataset.h"
#include "io/config/recording_draft.h"

namespace hindsight {

/// Where the unit of positions, or which column is the latitude, is a guess
/// (FoundStream::place_unit_told, place_order_told), takes of radians, the other
/// order, and both what fits the IMU's motion better than what is written, by more
/// than chance. The other order is an assumption: gyros of the other sign would turn the
/// same way. `load` gives the recording as the draft has it, nullptr if it does
/// not load.
void TellPlaces(const std::function<const Dataset*()>& load,
                RecordingDraft* draft);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_DRAFT_PLACES_H_
