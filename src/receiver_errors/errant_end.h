#ifndef HINDSIGHT_RECEIVER_ERRORS_ERRANT_END_H_
#define HINDSIGHT_RECEIVER_ERRORS_ERRANT_END_H_

#include <Eigen/Core>
#include <cstddef>
#include <optional>

#include "receiver_errors/weighed_hypotheses.h"

namespace hindsight {

struct SensorFindings;  // receiver_errors/sensor_findings.h

/// Odds of twenty, below which a result is doubtful [ln].
inline constexpr double kLeastLogOdds = 3.0;

/// Fixes with the first or the last of a recording, in all of which the sensor
/// errs: is biased or drifting, or by its slight errors more than three stated
/// sigmas off.
struct ErrantEnd {
  std::size_t first = 0;  ///< node
  std::size_t past = 0;   ///< node behind the last
  double begin = 0.0;     ///< [s]
  double end = 0.0;
  double share = 0.0;  ///< of the recording
  bool at_start = false;

  /// ln of the odds a priori against the hypothesis with the good and the
  /// erroneous fixes exchanged, of which the likelihood is the same: an erroneous
  /// stretch of the share s has not ended with the probability
  /// exp(-kEndsOfAnError s).
  double LogOdds() const;
  /// Whether these are below kLeastLogOdds.
  bool IsDoubtful() const;
};

/// The longer one of the stretches with the first and the last node in which the
/// chosen hypothesis has the sensor err; nothing where it does not, or does
/// throughout, or where it is not the only sensor of positions.
std::optional<ErrantEnd> FindErrantEnd(const SensorFindings& found);

/// Whether the only sensor of positions errs so from the first fix to the last in the
/// chosen hypothesis: then nothing but the prior of its errors tells positions.
bool ErrsThroughout(const SensorFindings& found);

/// The hypothesis with the good and the erroneous fixes exchanged: the
/// trajectory is that of the chosen one, moved by the error of the stretch, which
/// all other fixes have. The weight is its probability against the chosen one's:
/// by LogOdds, by how recordings begin (LogOddsOfBeginningWell), and by the start
/// as it is known a priori. Nothing where the error of the stretch varies by more
/// than a third of itself: then the exchanged one explains less.
std::optional<WeighedHypothesis> Exchanged(const SensorFindings& found,
                                           const ErrantEnd& errant);

/// Of a sensor that is off from its first fix to its last, by a constant up to a jump,
/// beside one other of positions, with which it agrees nowhere: the hypothesis by which
/// it is good up to the jump and the other off by that constant throughout. The
/// likelihood is the same. The weight is its probability against the chosen one's: an
/// error that begins in place of one that changes (LogOddsOfAnotherBias), one of the
/// other that does not end in what follows either, and the start as it is known a priori.
std::optional<WeighedHypothesis> ExchangedWithOther(
    const SensorFindings& found);

/// Of a sensor that is off by a constant (within a third of itself) of more than three
/// stated sigmas from its first fix to its last, beside one other of positions: ln of the
/// odds by which the start, as it is known a priori, tells that it is not the other.
/// Nothing else does. Nothing of other errors.
std::optional<double> LogOddsByStart(const SensorFindings& found);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_ERRANT_END_H_
