#ifndef HINDSIGHT_RECEIVER_ERRORS_SEQUENCE_PARTS_H_
#define HINDSIGHT_RECEIVER_ERRORS_SEQUENCE_PARTS_H_

#include <cstddef>
#include <vector>

#include "receiver_errors/mode_sequence.h"

namespace hindsight {

/// Biased or slightly.
bool IsBias(ErrorMode mode);
/// Good before the first fix.
ErrorMode ModeBefore(const ModeSequence& h, std::size_t i);
/// Fixes at which the receiver's error changes, whatever the IMU does, and the
/// end.
std::vector<std::size_t> Parts(const ModeSequence& h);
/// Gives fix i another step; whether it is an outlier is its own.
void SetStep(std::size_t i, ErrorStep step, ModeSequence* h);
/// Gives [begin, end) another error, drawn anew unless good, and keeps velocity steps.
void SetError(ErrorMode mode, std::size_t begin, std::size_t end,
              ModeSequence* h);
/// The sequence with its change at fix `from` at fix `to` instead, before the next change or
/// behind the last one. Velocity steps in between stay.
ModeSequence WithChangeMoved(ModeSequence h, std::size_t from, std::size_t to);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_SEQUENCE_PARTS_H_
