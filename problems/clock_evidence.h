#ifndef HINDSIGHT_PROBLEMS_CLOCK_EVIDENCE_H_
#define HINDSIGHT_PROBLEMS_CLOCK_EVIDENCE_H_

#include <memory>
#include <mutex>
#include <vector>

#include "dataset/dataset.h"
#include "problems/marginal_likelihood.h"
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

/// A chosen solution that rivals are compared with. Its likelihood is found once for
/// all rivals that have the same measurements. Several threads may ask at once.
class ChosenExplanation {
 public:
  /// Of `dataset`, where the clocks are as they are given; all must outlive it.
  ChosenExplanation(const Dataset& dataset, const Explained& chosen)
      : dataset_(dataset), chosen_(chosen) {}

  /// ln of the evidence of `rival` over that of the chosen solution, with the a priori
  /// distributions of the data set:
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
  double LogEvidenceRatio(const Explained& rival,
                          ExcessBy by = ExcessBy::kMean);

  /// The same with r = 1 and c by the mean, of two that make use of the same
  /// readings of the IMU at the same times.
  double LogLikelihoodRatio(const Explained& rival);

 private:
  struct Known {
    GateDecisions used;
    LikelihoodParts parts;
    MarginalLikelihood likelihood;
  };

  std::shared_ptr<const Known> Beside(const Explained& rival,
                                      LikelihoodParts parts);

  const Dataset& dataset_;
  Explained chosen_;
  std::mutex mutex_;
  std::shared_ptr<const Known> last_;
};

/// ChosenExplanation::LogEvidenceRatio of one rival.
double LogEvidenceRatio(const Dataset& dataset, const Explained& rival,
                        const Explained& chosen, ExcessBy by = ExcessBy::kMean);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_CLOCK_EVIDENCE_H_
