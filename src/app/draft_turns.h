#ifndef HINDSIGHT_APP_DRAFT_TURNS_H_
#define HINDSIGHT_APP_DRAFT_TURNS_H_

#include "dataset/dataset.h"
#include "io/config/recording_draft.h"

namespace hindsight {

/// Where the course over the ground turns otherwise than the gyros
/// (CourseOverGyros): takes the unit of these for the one that makes up for it, if
/// the file states none; and, if they turn the other way round, the gyros for those of
/// the other sign where gravity turns against them too, else the accelerometers for
/// those that read -1 g along the axis that points up; either is an assumption.
/// Whether the draft was changed.
bool TellTurns(const Dataset& dataset, RecordingDraft* draft);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_DRAFT_TURNS_H_
