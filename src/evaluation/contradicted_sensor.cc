#include "evaluation/contradicted_sensor.h"

#include <fmt/core.h>

namespace hindsight {

bool IsOutvoted(const Judged& judged, const std::string& sensor) {
  const LeftOutSensor* found = judged.contradiction;
  return found != nullptr && found->sensors.size() == 1 &&
         (found->sensors.front() == sensor ||
          found->sensors.front() == kPriorValues) &&
         found->effect < kUnusableBias;
}

void FindContradictedSensor(const Judged& judged,
                            std::vector<Evidence>* evidence) {
  const LeftOutSensor* found = judged.contradiction;
  if (found == nullptr || found->sensors.empty()) return;
  const std::string names = AsAlternatives(found->sensors);
  Evidence one{.grade = Grade::kDoubtful,
               .value = found->misfit,
               .limit = 1.0,
               .unit = "1",
               .t_begin = found->onset};
  if (found->sensors.size() == 1) {
    one.what =
        fmt::format("all else fits without {}, which it contradicts", names);
    one.causes = {"an error of " + names};
    one.remedies = {
        names == kPriorValues
            ? "other start values or constants, or larger sigmas of them"
            : "leaving " + names + " out"};
  } else {
    one.what = fmt::format(
        "all else fits without {}: they contradict each "
        "other",
        names);
    one.causes = {"an error of " + names};
  }
  if (found->onset) {
    one.what += fmt::format(", from {:.1f} s on", *found->onset);
  }
  evidence->push_back(std::move(one));
}

}  // namespace hindsight
