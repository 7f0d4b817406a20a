#ifndef HINDSIGHT_APP_DRAFT_REFINEMENT_H_
#define HINDSIGHT_APP_DRAFT_REFINEMENT_H_

#include <string>
#include <vector>

#include "app/progress.h"
#include "io/config/recording_draft.h"

namespace hindsight {

/// Loads the recording as drafted and puts into the draft what its readings
/// tell, each with the reason: the axes that gravity shows; the white noise of
/// the IMU's readings and bias sigmas to match; the offset of each stream's clock
/// (SearchClock) and, over 200 s and more, how fast the IMU's clock runs against
/// it; the vehicle's forward axis (FindMounting), and with it that it runs on
/// wheels; radius and direction of a wheel against the speed of positions; which
/// axis is mirrored; at last the noise as EstimateNoise finds it. What they do not
/// tell becomes an assumption. A draft that does not load says so
/// (RecordingDraft::loads). `progress` is told what is looked at.
void RefineDraft(Progress* progress, RecordingDraft* draft);

/// The drafts of all recordings below `folder`, refined. Throws InputError as
/// DraftRecordings does.
std::vector<RecordingDraft> DraftFolder(const std::string& folder,
                                        Progress* progress);

/// Whether nothing but the attitude can be estimated: no stream says where the
/// IMU is or how it moves.
bool IsAttitudeAlone(const RecordingDraft& draft);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_DRAFT_REFINEMENT_H_
