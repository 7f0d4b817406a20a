#ifndef HINDSIGHT_APP_DRAFT_TRUTH_H_
#define HINDSIGHT_APP_DRAFT_TRUTH_H_

#include "dataset/dataset.h"
#include "io/config/recording_draft.h"

namespace hindsight {

/// Where no stream tells the place, and a truth lies elsewhere than the one that
/// was put in its stead, the truth's first.
void TakePlaceOfTruth(const Dataset& dataset, RecordingDraft* draft);

/// Of which point a truth speaks, where its velocities in turns tell.
void TellTruthPoint(const Dataset& dataset, RecordingDraft* draft);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_DRAFT_TRUTH_H_
