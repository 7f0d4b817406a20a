#include "problems/outlier_rows.h"

#include <cstddef>
#include <vector>

#include "base/median.h"

namespace hindsight {

RowAtGap LongestRowAtGap(std::span<const TakenFix> fixes) {
  constexpr double kGap = 5.0;
  std::vector<double> spacings;
  for (std::size_t i = 1; i < fixes.size(); ++i) {
    spacings.push_back(fixes[i].t - fixes[i - 1].t);
  }
  const double gap = spacings.empty() ? 0.0 : kGap * Median(spacings);
  RowAtGap longest;
  for (std::size_t begin = 0; begin < fixes.size();) {
    std::size_t end = begin + 1;
    while (end < fixes.size() && fixes[end].outlier == fixes[begin].outlier &&
           spacings[end - 1] <= gap) {
      ++end;
    }
    const bool at_gap = begin == 0 || end == fixes.size() ||
                        spacings[begin - 1] > gap || spacings[end - 1] > gap;
    const auto count = static_cast<int>(end - begin);
    if (fixes[begin].outlier && at_gap && count > longest.count) {
      longest = {fixes[begin].t, fixes[end - 1].t, count};
    }
    begin = end;
  }
  return longest;
}

}  // namespace hindsight
