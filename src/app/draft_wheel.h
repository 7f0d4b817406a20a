#ifndef HINDSIGHT_APP_DRAFT_WHEEL_H_
#define HINDSIGHT_APP_DRAFT_WHEEL_H_

#include "dataset/dataset.h"
#include "io/config/recording_draft.h"

namespace hindsight {

/// Puts into a draft what the speed of positions says of odometers (FindWheel): of
/// a wheel that turns at a rate its radius and direction, of an IMU on one also its
/// clock; of a speed that has no unit the unit, or else its scale; of any the sign.
/// Whether the draft was changed.
bool TellWheels(const Dataset& dataset, RecordingDraft* draft);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_DRAFT_WHEEL_H_
