#ifndef HINDSIGHT_DATASET_CLOCK_DRIFT_H_
#define HINDSIGHT_DATASET_CLOCK_DRIFT_H_

#include <optional>

#include "dataset/dataset.h"

namespace hindsight {

/// How fast the IMU's clock runs against that of a stream.
struct ClockDrift {
  double change = 0.0;  ///< of the stream's offset from its first third to its
                        ///< last, and its standard deviation [s]
  double sigma = 0.0;
  double rate = 0.0;  ///< change over the time between them
};

/// The offset of the stream's clock (SearchClock, within 1 s of the present one)
/// in the first and in the last third. Nothing if it is ambiguous or not found
/// in either.
std::optional<ClockDrift> FindClockDrift(const Dataset& dataset,
                                         const AidingStream& stream);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_CLOCK_DRIFT_H_
