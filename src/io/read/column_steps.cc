#include "io/read/column_steps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/median.h"

namespace hindsight {
namespace {

/// Of rows.
constexpr double kMostlyGrowing = 0.99;

}  // namespace

Steps StepsOf(const std::vector<double>& t) {
  Steps steps;
  std::vector<double> positive;
  std::size_t kept = 0;
  for (std::size_t i = 1; i < t.size(); ++i) {
    const double step = t[i] - t[i - 1];
    if (step >= 0.0) ++kept;
    if (step > 0.0) positive.push_back(step);
    steps.repeated = steps.repeated || step == 0.0;
    steps.unordered = steps.unordered || step < 0.0;
  }
  if (t.size() < 2 || positive.empty()) return steps;
  steps.median = Median(positive);
  for (const double step : positive) {
    steps.longest = std::max(steps.longest, step);
    steps.unevenness =
        std::max(steps.unevenness, std::abs(step / steps.median - 1.0));
  }
  steps.growing = static_cast<double>(kept) / static_cast<double>(t.size() - 1);
  return steps;
}

bool Grows(const std::vector<double>& t, const Steps& steps) {
  return steps.growing >= kMostlyGrowing && t.back() > t.front() &&
         std::all_of(t.begin(), t.end(),
                     [](double x) { return std::isfinite(x); });
}

bool AreWholeNumbers(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double x) {
    return std::isnan(x) || x == std::round(x);
  });
}

bool IsSteady(const std::vector<double>& t, const Steps& steps) {
  const double mean =
      (t.back() - t.front()) / static_cast<double>(t.size() - 1);
  return steps.median < 3.0 * mean && mean < 10.0 * steps.median;
}

}  // namespace hindsight
