#ifndef HINDSIGHT_IO_READ_TICK_CLOCK_H_
#define HINDSIGHT_IO_READ_TICK_CLOCK_H_

#include <cstdint>

#include "io/read/time_scale.h"

namespace hindsight {

/// Turns whole numbers of ticks into stamps without rounding to a double: a
/// tick is the ratio of whole numbers, the simplest within rounding of its
/// length as a double (60, 3/1000, 1/1000000000). The fraction of a second is
/// good to 1e-15 s.
class TickClock {
 public:
  /// `seconds_per_tick` lies between 1e-12 and 1e9.
  explicit TickClock(double seconds_per_tick);

  /// The time must be one (IsTime).
  Stamp At(bool negative, std::uint64_t ticks) const;

  static bool IsLength(double seconds_per_tick) {
    return seconds_per_tick >= 1e-12 && seconds_per_tick <= 1e9;
  }

 private:
  std::uint64_t numerator_ = 1;
  std::uint64_t denominator_ = 1;
};

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_TICK_CLOCK_H_
