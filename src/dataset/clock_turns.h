#ifndef HINDSIGHT_DATASET_CLOCK_TURNS_H_
#define HINDSIGHT_DATASET_CLOCK_TURNS_H_

#include <optional>
#include <vector>

#include "dataset/clock_comparison.h"

namespace hindsight {

/// Turns of a truth's attitude against those of the gyros; nothing of one
/// without attitudes.
std::optional<ClockComparison> CompareTurns(const ImuStream& imu,
                                            const TruthSeries& truth);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_CLOCK_TURNS_H_
