#ifndef HINDSIGHT_PROBLEMS_CLOCKS_WITHOUT_H_
#define HINDSIGHT_PROBLEMS_CLOCKS_WITHOUT_H_

#include <optional>
#include <set>
#include <utility>

#include "problems/clock_choice.h"
#include "problems/node_placement.h"

namespace hindsight {

/// A measurement by its sensor, an index into Dataset::streams, and stamp [s].
using MeasurementKey = std::pair<int, double>;

/// Clocks that were chosen without some measurements, and what methods begin from
/// with all of them.
struct ClocksWithout {
  ClockChoice choice;  ///< its stage has run, without them
  PlacedNodes nodes;   ///< of its data set, with them
};

/// ChooseClocks of the same recording as if the measurements `erring` had been
/// withheld. Nothing if the others do not tell the clocks, or cannot be solved.
std::optional<ClocksWithout> ChooseClocksWithout(
    const std::set<MeasurementKey>& erring, const Dataset& given,
    const ReconstructionOptions& options);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_CLOCKS_WITHOUT_H_
