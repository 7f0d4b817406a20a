#ifndef HINDSIGHT_RECEIVER_ERRORS_HIDDEN_CHANGES_H_
#define HINDSIGHT_RECEIVER_ERRORS_HIDDEN_CHANGES_H_

#include <cstddef>
#include <vector>

#include "receiver_errors/mode_sequence.h"

namespace hindsight {

/// Hypotheses in which a gap hides how an error begins or ends: a change of `sequence` is
/// behind an earlier or a later gap; or that which begins at it ends behind a gap, or that
/// which ends there begins behind one; or
/// the receiver is good on that side of the change and errs on the other, up to a gap or
/// from one on. `behind_gaps` are the first fixes behind gaps, in order; of those on a
/// side up to the next change the four next to the change.
std::vector<ModeSequence> HiddenChanges(
    const ModeSequence& sequence, const std::vector<std::size_t>& behind_gaps);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_HIDDEN_CHANGES_H_
