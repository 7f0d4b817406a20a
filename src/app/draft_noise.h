#ifndef HINDSIGHT_APP_DRAFT_NOISE_H_
#define HINDSIGHT_APP_DRAFT_NOISE_H_

#include <functional>

#include "dataset/dataset.h"
#include "io/config/recording_draft.h"

namespace hindsight {

/// Puts into a draft what the loaded recording says of its noise, each with the
/// reason.
///
/// White noise of the IMU's readings (NoiseOfReadings), and the walks and the
/// sigmas of biases that are usual beside it.
void TellReadingNoise(const Dataset& dataset, RecordingDraft* draft);

/// White noise of positions whose errors are taken to last (NoiseOfFixes), where
/// the fixes show more of it than was guessed; what lasts is no less than it.
void TellFixNoise(const Dataset& dataset, RecordingDraft* draft);

/// What the likelihood of the innovations says (EstimateNoise), where it says
/// something: of the IMU, of stated sigmas and, if they are larger than thought,
/// of constraints and of positions whose errors last. Noise thirty times that which
/// the readings show, or a thirtieth, is no device's: then nothing is taken over,
/// and that something else is wrong becomes an assumption. `progress` gets the fraction
/// done.
void TellLikelyNoise(const Dataset& dataset,
                     const std::function<void(double)>& progress,
                     RecordingDraft* draft);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_DRAFT_NOISE_H_
