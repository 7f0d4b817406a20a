#include "dataset/clock_drift.h"

#include <cmath>

#include "dataset/clock_search.h"

namespace hindsight {
namespace {

AidingStream Part(const AidingStream& stream, double from, double to) {
  AidingStream part;
  part.sensor = stream.sensor;
  part.sensor.time_offset = 0.0;
  for (const Measurement& z : stream.measurements) {
    if (z.t >= from && z.t < to) part.measurements.push_back(z);
  }
  return part;
}

}  // namespace

std::optional<ClockDrift> FindClockDrift(const Dataset& dataset,
                                         const AidingStream& stream) {
  constexpr double kThird = 1.0 / 3.0;
  const double begin = stream.measurements.front().t;
  const double span = stream.measurements.back().t - begin;
  const double offset = stream.sensor.time_offset;
  const auto search = [&](double from, double to) {
    return SearchClock(dataset.imu, dataset.initial,
                       Part(stream, begin + from * span, begin + to * span),
                       {offset - 1.0, offset + 1.0});
  };
  const ClockSearch early = search(0.0, kThird);
  const ClockSearch late = search(2.0 * kThird, 1.1);
  if (early.candidates.size() != 1 || late.candidates.size() != 1) {
    return std::nullopt;
  }
  const double change = late.candidates[0].offset - early.candidates[0].offset;
  return ClockDrift{
      change, std::hypot(late.candidates[0].sigma, early.candidates[0].sigma),
      change / (2.0 * kThird * span)};
}

}  // namespace hindsight
