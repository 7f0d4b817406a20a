#ifndef HINDSIGHT_RECEIVER_ERRORS_HELD_OUT_SCORE_H_
#define HINDSIGHT_RECEIVER_ERRORS_HELD_OUT_SCORE_H_

#include <vector>

#include "receiver_errors/hypothesis_search.h"

namespace hindsight {

/// Fixes first to past the last.
struct HeldOutStretch {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Lengths of the stretches that are held out [s]: shorter and longer than what
/// most errors of a receiver and outages last.
inline constexpr double kHeldOutLengths[] = {3.0, 10.0, 30.0};

/// Stretches of about `length` [s] without overlap: evenly over the tape, and
/// one about each change point of the hypotheses, where they differ most from
/// each other.
std::vector<HeldOutStretch> HeldOutStretches(
    const SensorTape& tape, double length,
    const std::vector<const ModeSequence*>& sequences);

/// How well the fixes of a stretch are predicted.
struct HeldOutScore {
  double log_density = 0.0;  ///< mean a fix
  /// ln of the root of 1 + the mean square of the distance from the prediction, in
  /// stated sigmas: nearer than its sigma a fix tells no distance.
  double log_distance = 0.0;
};

/// How a hypothesis predicts the fixes of each stretch. The fixes of the stretch are taken out, the
/// sensor's others, and all of other sensors, are not: the state at a fix is
/// what the filter of all before says joined with what the measurements after
/// say (LaterLikelihood). The decisions within are taken back: velocity steps do
/// not happen, and where the sequence changes, the last of its changes may come
/// at any fix of the stretch, or after it, each equally likely:
///   p = sum_c prod_(i < c) p(z_i | before) prod_(i >= c) p(z_i | after) / (m + 1).
/// Of the distances the smaller of the two counts there. So that a few fixes which no hypothesis explains do not decide, the density
/// of a fix is 99 % of that and 1 % uniform over 200 stated sigmas an axis.
std::vector<HeldOutScore> ScoreHeldOut(
    const SensorTape& tape, const Hypothesis& hypothesis,
    const std::vector<HeldOutStretch>& stretches);

/// A mean over stretches and its standard error.
struct MeanOfStretches {
  double mean = 0.0;
  double sigma = 0.0;
};

/// Standard errors, estimated from so many stretches, that are as improbable as
/// two that are known: the quantile of Student's distribution, in the expansion of
/// Abramowitz and Stegun (1964), 26.7.5; 4.4 of 3 stretches, 2.3 of 10.
double LimitOf(int stretches);

/// Differences of two scores, paired by stretches.
struct HeldOutDifference {
  double length = 0.0;  ///< of the stretches [s]
  int stretches = 0;
  MeanOfStretches log_density;
  MeanOfStretches log_distance;
  /// The first is worse beyond what the scatter over stretches explains, by more
  /// than LimitOf(stretches) standard errors: of the density, or of the distance,
  /// which knows nothing of sigmas.
  bool LosesDensity() const {
    return log_density.mean < -LimitOf(stretches) * log_density.sigma;
  }
  bool LosesDistance() const {
    return log_distance.mean > LimitOf(stretches) * log_distance.sigma;
  }
  bool Loses() const { return LosesDensity() || LosesDistance(); }
};

/// Of `hypothesis` less `simpler`, for each of kHeldOutLengths that the tape is
/// long enough for to hold out three stretches.
std::vector<HeldOutDifference> CompareHeldOut(const SensorTape& tape,
                                              const Hypothesis& hypothesis,
                                              const Hypothesis& simpler);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_HELD_OUT_SCORE_H_
