#include "evaluation/explanation.h"

#include <fmt/core.h>

namespace hindsight {

void FindBetterExplanation(const Judged& judged,
                           std::vector<Evidence>* evidence) {
  const Explanation* best = nullptr;
  for (const Explanation& one : judged.explanations) {
    if (one.z < one.limit || one.effect < one.shift_that_matters) continue;
    if (best == nullptr || one.z / one.limit > best->z / best->limit) {
      best = &one;
    }
  }
  if (best == nullptr) return;
  evidence->push_back(
      {.grade = Grade::kDoubtful,
       .what = fmt::format(
           "{}: {:.1f} sigma (limit {:.1f}), which moves {} by {:.1f} sigma",
           best->what, best->z, best->limit, best->component, best->effect),
       .value = best->z,
       .limit = best->limit,
       .unit = "sigma",
       .t_begin = best->onset,
       .remedies = {best->remedy}});
}

}  // namespace hindsight
