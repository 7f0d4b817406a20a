#ifndef HINDSIGHT_RECEIVER_ERRORS_SEQUENCE_VARIATIONS_H_
#define HINDSIGHT_RECEIVER_ERRORS_SEQUENCE_VARIATIONS_H_

#include <functional>
#include <vector>

#include "receiver_errors/mode_sequence.h"

namespace hindsight {

/// Hypotheses that differ from `sequence` at one change: it comes up to eight
/// fixes earlier or later, does not come, is of another kind, or follows a
/// bias; or it and all changes after it are velocity steps of the IMU; or a step where it
/// begins, or there and where it ends, is in place of the error of a stretch; or the
/// stretches before and after it change roles, the good one being the erroneous one.
std::vector<ModeSequence> Variations(const ModeSequence& sequence);
/// Hypotheses with one velocity_step of the IMU more than `sequence`: one for each fix at
/// which nothing changes and which has no velocity_step.
/// Each is shown to `visit` alone, as long as that returns true: of a long
/// recording all together would take gigabytes.
void ForEachVelocityStep(const ModeSequence& sequence,
                         const std::function<bool(const ModeSequence&)>& visit);

/// Where `sequence` is biased, or slightly, at its last fixes, one with these good
/// and all before biased; where it errs at its first, one with those good and all
/// behind biased. By fixes alone a jump tells one as well as the other. Nothing
/// where it errs throughout.
std::vector<ModeSequence> RolesExchanged(const ModeSequence& sequence);

/// Where `sequence` jumps to a bias, or a slight one, that lasts to its last fix, or
/// from one that it has from its first, the jump as the end of a drift, with which
/// the sensor comes back, and no velocity steps: one for each length of the drift, a
/// quarter apart.
std::vector<ModeSequence> DriftsThatEnd(const ModeSequence& sequence);

/// An error too small to be found alone may have begun at any time before a
/// change: each time is unlikely, all together may not be. And a jump may be
/// the end of a drift that began unseen. Lengths are a quarter apart, each
/// stands for `count`, those up to the next. Each is shown to `visit` alone, as by
/// ForEachVelocityStep.
void ForEachEarlierError(
    const ModeSequence& sequence,
    const std::function<bool(const ModeSequence&, double count)>& visit);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_SEQUENCE_VARIATIONS_H_
