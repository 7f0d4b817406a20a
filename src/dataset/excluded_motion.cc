#include "dataset/excluded_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hindsight {

bool ExcludedMotion::empty() const {
  return std::all_of(record_.streams().begin(), record_.streams().end(),
                     [](const auto& stream) { return stream.all.empty(); });
}

double ExcludedMotion::PossibleSpeed(const TimeInterval& span) const {
  double least_sigma = std::numeric_limits<double>::infinity();
  double possible = least_sigma;
  for (const SpeedEvidence& speed : record_.Over(span)) {
    if (!(speed.horizontal_sigma() < least_sigma)) continue;
    least_sigma = speed.horizontal_sigma();
    possible = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(speed.sigma(axis))) continue;
      possible =
          std::max(possible, std::hypot(speed.v(axis), speed.sigma(axis)));
    }
  }
  return possible;
}

void ExcludedMotion::Cut(const TimeInterval& span,
                         std::vector<TimeInterval>* remaining,
                         std::vector<TimeInterval>* cut) const {
  constexpr double kShortest = 2.0;
  int parts = 1;
  while (span.length() / (2 * parts) >= kShortest) parts *= 2;
  // What moves is cut as closely as it shows.
  for (; parts >= 1; parts /= 2) {
    const double length = span.length() / parts;
    for (int k = 0; k < 2 * parts - 1; ++k) {
      const double begin = span.begin + 0.5 * k * length;
      const TimeInterval part = {begin, std::min(begin + length, span.end)};
      if (!Contradicts(part)) continue;
      // What is not much longer than it would not show the same motion.
      const TimeInterval before = {span.begin, part.begin};
      const TimeInterval after = {part.end, span.end};
      TimeInterval moves = part;
      if (before.length() < 2.0 * length) {
        moves.begin = before.begin;
      } else {
        Cut(before, remaining, cut);
      }
      if (after.length() < 2.0 * length) moves.end = after.end;
      cut->push_back(moves);
      if (moves.end < span.end) Cut(after, remaining, cut);
      return;
    }
  }
  remaining->push_back(span);
}

bool ExcludedMotion::Contradicts(const TimeInterval& span) const {
  constexpr double kSigmas = 4.0;
  const double windows = std::max(1.0, span.length() / window_);
  const double slack = slack_ / std::sqrt(windows);
  for (const SpeedEvidence& speed : record_.Over(span)) {
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(speed.v(axis)) > kSigmas * speed.sigma(axis) + slack) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace hindsight
