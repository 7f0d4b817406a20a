#ifndef HINDSIGHT_PROBLEMS_CLOCK_EVIDENCE_H_
#define HINDSIGHT_PROBLEMS_CLOCK_EVIDENCE_H_

#include <vector>

#include "dataset/dataset.h"
#include "timeline/problem.h"

namespace hindsight {

/// An explanation of the data, and the states it led to.
struct Explained {
  const Problem& problem;
  const std::vector<State>& states;
};

/// What tells by how much the noise is larger than stated: the mean square of
/// the normalised innovations of the chosen solution, or the median of squares,
/// each by that of its chi-square distribution, for which a few that err do not
/// count.
enum class ExcessBy { kMean, kMedian };

/// ln of the evidence of `rival` over that of `chosen`, with the a priori
/// distributions of `dataset`, where the clocks are as they are given:
///   r (L_rival - L_chosen)/c + difference of LogClockPrior,
///   r = max(0, 1 - 2 c m/|w|^2).
/// L: MarginalLikelihoodOf the measurements that both have inside the IMU's
/// record. c: by how much the noise is larger than stated, at least 1, as `by`
/// says. w: by what the two predictions of these measurements differ, as the
/// difference of the whitened innovations; m: the mean of
/// MarginalLikelihood::imu_noise. With two clocks the measurements meet the
/// IMU's noise of two different times, which adds 2 c m to |w|^2. Where the
/// motion repeats itself, the predictions differ in nothing but this noise, and
/// which of them happens to fit better tells nothing. r is the part of |w|^2
/// that comes from motion, by which the difference of the likelihoods has to be
/// multiplied (the attenuation of errors in variables).
double LogEvidenceRatio(const Dataset& dataset, const Explained& rival,
                        const Explained& chosen, ExcessBy by = ExcessBy::kMean);

/// The same with r = 1 and c by the mean, of two that make use of the same
/// readings of the IMU at the same times.
double LogLikelihoodRatio(const Dataset& dataset, const Explained& rival,
                          const Explained& chosen);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_CLOCK_EVIDENCE_H_
