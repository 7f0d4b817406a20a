#include "dataset/resolution.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace hindsight {
namespace {

/// The differences of neighbours in order of size.
std::vector<double> Gaps(std::vector<double> values,
                         const ReadingRounding& rounding) {
  std::sort(values.begin(), values.end());
  std::vector<double> gaps;
  for (std::size_t k = 1; k < values.size(); ++k) {
    const double gap = values[k] - values[k - 1];
    if (gap >
        std::max(rounding.absolute, rounding.relative * std::abs(values[k]))) {
      gaps.push_back(gap);
    }
  }
  return gaps;
}

double Least(const std::vector<double>& gaps) {
  const auto least = std::min_element(gaps.begin(), gaps.end());
  return least == gaps.end() ? std::numeric_limits<double>::infinity() : *least;
}

}  // namespace

double Resolution(std::vector<double> readings, const ReadingRounding& rounding,
                  ReadingCourse course) {
  std::vector<double> gaps = Gaps(std::move(readings), rounding);
  const double least = Least(gaps);
  if (course == ReadingCourse::kToAndFro) return least;
  return std::min(least, Least(Gaps(std::move(gaps), rounding)));
}

}  // namespace hindsight
