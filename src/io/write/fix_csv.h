#ifndef HINDSIGHT_IO_WRITE_FIX_CSV_H_
#define HINDSIGHT_IO_WRITE_FIX_CSV_H_

#include <string>

#include "dataset/dataset.h"
#include "state/solution.h"

namespace hindsight {

/// Every measured position at the point that it speaks of, stream by stream, a
/// line each:
///   t[s]                  stamp + time offset, the estimated one if there is
///   sensor
///   lat[deg] lon[deg] h[m]        WGS-84, height above the ellipsoid
///   sd_n[m] sd_e[m] sd_d[m]       as stated
///   quality, satellites   as the receiver says, in its own numbers; empty
///                         where its file has none
///   status                used, rejected (by the gate), withheld, or unused
///                         (outside of what was reconstructed)
///   weight                that `solution` gave it, 1 = full; 0 if not used
/// after comments that begin with '#', one of which says what t = 0 is. Throws
/// OutputError if the file cannot be written.
void WriteFixCsv(const std::string& path, const Solution& solution,
                 const Dataset& dataset);

/// Whether a stream of the data set measures positions.
bool HasFixes(const Dataset& dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_FIX_CSV_H_
