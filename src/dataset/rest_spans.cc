#include <algorithm>
#include <cmath>

#include "dataset/rest.h"

namespace hindsight {

double TotalLength(const std::vector<TimeInterval>& spans) {
  double total = 0.0;
  for (const TimeInterval& span : spans) total += span.length();
  return total;
}

std::optional<TimeInterval> RestFrom(double t,
                                     const std::vector<TimeInterval>& rests) {
  constexpr double kSlack = 1.0;  // [s]
  std::optional<TimeInterval> found;
  for (const TimeInterval& rest : rests) {
    if (rest.begin <= t + kSlack && rest.end > t + kSlack) {
      found = TimeInterval{std::max(t, rest.begin), rest.end};
    }
  }
  return found;
}

std::vector<TimeInterval> WindowsOf(const TimeInterval& span,
                                    const StationaryOptions& options) {
  constexpr double kLongest = 1.0;
  constexpr double kRounding = 1e-6;
  const double window = std::min(options.window, kLongest);
  const auto count =
      static_cast<int>(std::floor(span.length() / window + kRounding));
  std::vector<TimeInterval> windows;
  for (int i = 0; i < count; ++i) {
    windows.push_back({span.begin + i * window, span.begin + (i + 1) * window});
  }
  return windows;
}

}  // namespace hindsight
