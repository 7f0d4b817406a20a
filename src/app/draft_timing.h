#ifndef HINDSIGHT_APP_DRAFT_TIMING_H_
#define HINDSIGHT_APP_DRAFT_TIMING_H_

#include "dataset/dataset.h"
#include "io/config/recording_draft.h"

namespace hindsight {

/// Puts into a draft what the motion of the loaded recording says of its clocks,
/// each with the reason.
///
/// The offset of each stream's clock (SearchClock), every one where several fit;
/// those of IMUs on wheels are told with the wheels (TellWheels).
void TellClocks(const Dataset& dataset, RecordingDraft* draft);

/// Of attitude alone: how late a magnetometer's stamps are, where its field turns
/// with the gyros and tells to 20 ms.
void TellFieldClock(const Dataset& dataset, RecordingDraft* draft);

/// How fast the IMU's clock runs against that of the first stream of positions or
/// velocities, over 200 s and more (FindClockDrift).
void TellStretch(const Dataset& dataset, RecordingDraft* draft);

/// Where the clock of a truth with attitudes stands, if 20 ms off or more.
void TellTruthClock(const Dataset& dataset, RecordingDraft* draft);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_DRAFT_TIMING_H_
