#ifndef HINDSIGHT_ALIGNMENT_JUDGEMENT_H_
#define HINDSIGHT_ALIGNMENT_JUDGEMENT_H_

#include <optional>

#include "alignment/alignment.h"

namespace hindsight {

/// By how much the log-evidence of attitude `a` exceeds that of `b`: the
/// log-likelihoods of all that WindowSmoother uses, each with its attitude and
/// covariance as prior, over `nis` where the better one's exceeds one. Windows
/// of 10, 20, 40... 160 s from the first measurement are tried until one
/// decides by more than kDecided; the last is returned. Absent without aiding
/// that could tell.
std::optional<double> Judge(const AlignmentInput& input,
                            const AlignedAttitude& a, const AlignedAttitude& b);

/// Odds of 150 to 1.
inline constexpr double kDecided = 5.0;

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_JUDGEMENT_H_
