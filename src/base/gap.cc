#include "base/gap.h"

#include "base/median.h"

namespace hindsight {

double LongestSpacingWithoutGap(const std::vector<double>& spacings) {
  constexpr double kByMedian = 5.0;
  return kByMedian * Median(spacings);
}

}  // namespace hindsight
