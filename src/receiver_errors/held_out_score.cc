#include "receiver_errors/held_out_score.h"

#include <algorithm>
#include <cmath>

#include "receiver_errors/held_out_prediction.h"
#include "receiver_errors/sensor_tape.h"

namespace hindsight {
namespace {

MeanOfStretches MeanOf(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  MeanOfStretches out;
  double squares = 0.0;
  for (const double one : values) {
    out.mean += one / n;
    squares += one * one / n;
  }
  out.sigma =
      std::sqrt(std::max(0.0, squares - out.mean * out.mean) / (n - 1.0));
  return out;
}

/// Times of the sensor's fixes.
std::vector<double> FixTimes(const SensorTape& tape) {
  std::vector<double> times;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    if (tape.HasFix(k)) times.push_back(tape.t(k));
  }
  return times;
}

HeldOutStretch StretchAt(const std::vector<double>& times, double begin,
                         double length) {
  const auto first = std::lower_bound(times.begin(), times.end(), begin);
  const auto last = std::lower_bound(first, times.end(), begin + length);
  return {static_cast<std::size_t>(first - times.begin()),
          static_cast<std::size_t>(last - times.begin())};
}

}  // namespace

double LimitOf(int stretches) {
  constexpr double z = 2.0;
  constexpr double z2 = z * z;
  const double n = stretches - 1.0;
  const double first = z * (z2 + 1.0) / 4.0;
  const double second = z * ((5.0 * z2 + 16.0) * z2 + 3.0) / 96.0;
  const double third =
      z * (((3.0 * z2 + 19.0) * z2 + 17.0) * z2 - 15.0) / 384.0;
  return z + first / n + second / (n * n) + third / (n * n * n);
}

std::vector<HeldOutStretch> HeldOutStretches(
    const SensorTape& tape, double length,
    const std::vector<const ModeSequence*>& sequences) {
  constexpr double kMost = 40.0;
  const std::vector<double> times = FixTimes(tape);
  std::vector<double> begins;
  const double span = times.empty() ? 0.0 : times.back() - times.front();
  for (const ModeSequence* sequence : sequences) {
    ErrorMode mode = ErrorMode::kGood;
    for (std::size_t i = 0; i < sequence->size(); ++i) {
      const ErrorStep& step = (*sequence)[i];
      if (step.anew || step.velocity_step || step.mode != mode) {
        begins.push_back(times[i] - 0.5 * length);
      }
      mode = step.mode;
    }
  }
  const double count = std::min(kMost, std::floor(span / length));
  for (double i = 0.0; i < count; ++i) {
    begins.push_back(times.front() + i * span / count);
  }
  std::vector<HeldOutStretch> stretches;
  for (const double begin : begins) {
    const HeldOutStretch one = StretchAt(times, begin, length);
    const bool overlaps = std::any_of(
        stretches.begin(), stretches.end(), [&](const HeldOutStretch& other) {
          return one.begin < other.end && other.begin < one.end;
        });
    if (one.begin < one.end && !overlaps) stretches.push_back(one);
  }
  return stretches;
}

std::vector<HeldOutScore> ScoreHeldOut(
    const SensorTape& tape, const Hypothesis& hypothesis,
    const std::vector<HeldOutStretch>& stretches) {
  HeldOutPrediction prediction(tape, hypothesis);
  std::vector<HeldOutScore> scores;
  for (const HeldOutStretch& stretch : stretches) {
    scores.push_back(prediction.Score(stretch));
  }
  return scores;
}

std::vector<HeldOutDifference> CompareHeldOut(const SensorTape& tape,
                                              const Hypothesis& hypothesis,
                                              const Hypothesis& simpler) {
  constexpr std::size_t kLeast = 3;
  std::vector<HeldOutDifference> out;
  HeldOutPrediction of_it(tape, hypothesis);
  HeldOutPrediction of_simpler(tape, simpler);
  for (const double length : kHeldOutLengths) {
    const std::vector<HeldOutStretch> stretches = HeldOutStretches(
        tape, length, {&hypothesis.sequence, &simpler.sequence});
    if (stretches.size() < kLeast) continue;
    std::vector<double> density;
    std::vector<double> distance;
    for (const HeldOutStretch& stretch : stretches) {
      const HeldOutScore a = of_it.Score(stretch);
      const HeldOutScore b = of_simpler.Score(stretch);
      density.push_back(a.log_density - b.log_density);
      distance.push_back(a.log_distance - b.log_distance);
    }
    out.push_back({length, static_cast<int>(stretches.size()), MeanOf(density),
                   MeanOf(distance)});
  }
  return out;
}

}  // namespace hindsight
