#ifndef HINDSIGHT_IO_CONFIG_DRAFT_CLOCKS_H_
#define HINDSIGHT_IO_CONFIG_DRAFT_CLOCKS_H_

#include "io/config/recording_draft.h"

namespace hindsight {

/// Sets the `time` of every stream of a draft: stamps that are counted get their
/// rate, seconds since 1970 their clock. Where fixes are dated and the IMU is
/// not, it begins when the time tag beside it says (io/read/rtklib_tag.h), which
/// stretches it where its own stamps are no quartz's or longer than 2000 s, or
/// with the first fix; where the IMU is dated, streams that are not, or lie
/// elsewhere, begin with it; other records that overlap by less than half of the
/// shorter begin together. What is a guess becomes an assumption.
void SetDraftClocks(RecordingDraft* draft);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_DRAFT_CLOCKS_H_
