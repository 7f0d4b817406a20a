#ifndef HINDSIGHT_IMU_SAMPLE_SEARCH_H_
#define HINDSIGHT_IMU_SAMPLE_SEARCH_H_

#include <algorithm>
#include <cstddef>

#include "imu/imu_stream.h"

namespace hindsight {

/// The first sample at or after t, as many as there are if there is none. Sought
/// from where regular stamps would have it: bisection of a whole day would take
/// all over the recording into memory.
std::size_t FirstSampleAt(const ImuStream& imu, double t);

/// The first sample after t, likewise.
std::size_t FirstSampleAfter(const ImuStream& imu, double t);

/// Calls use(before, sample) for samples `first` >= 1 to `end` - 1 and those before
/// them, until one call is false.
template <typename Use>
void WalkSamples(const ImuStream& imu, std::size_t first, std::size_t end,
                 const Use& use) {
  end = std::min(end, imu.samples.size());
  if (first >= end) return;
  // Copied: the block that it is in may be let go.
  ImuSample before = imu.samples[first - 1];
  for (std::size_t k = first; k < end;) {
    const auto piece = imu.samples.Piece(k);
    const std::size_t count = std::min(piece.size(), end - k);
    const ImuSample* last = &before;
    for (const ImuSample& sample : piece.first(count)) {
      if (!use(*last, sample)) return;
      last = &sample;
    }
    before = *last;
    k += count;
  }
}

}  // namespace hindsight

#endif  // HINDSIGHT_IMU_SAMPLE_SEARCH_H_
