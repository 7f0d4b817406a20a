#ifndef HINDSIGHT_APP_TERMINAL_H_
#define HINDSIGHT_APP_TERMINAL_H_

#include "io/write/table.h"

namespace hindsight {

/// How tables are to be written to standard output: as wide as COLUMNS of the
/// environment says, else as the terminal is, else without end; in colour on a
/// terminal, unless it is called dumb or NO_COLOR is set and not empty.
TableStyle StyleOfOutput();

/// From now on nothing reaches standard output.
void SilenceOutput();

}  // namespace hindsight

#endif  // HINDSIGHT_APP_TERMINAL_H_
