#include "timeline/velocity_step.h"

#include <algorithm>

namespace hindsight {

VelocityStep::Noise VelocityStep::Within(double from, double to) const {
  const double first = std::max(begin, from);
  const double last = std::min(end, to);
  const bool at_once = begin == end;
  if (at_once ? begin < from || begin >= to : first >= last) return {};
  const double share =
      at_once ? variance : variance * (last - first) / (end - begin);
  const GrowthMoments grown = GrowthMoments::Between(to - last, to - first);
  return {share * grown.square, share * grown.by_rate, share};
}

}  // namespace hindsight
