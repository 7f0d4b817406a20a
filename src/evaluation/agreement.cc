#include "evaluation/agreement.h"

#include <fmt/core.h>

namespace hindsight {

void FindDisagreeingSides(const Judged& judged,
                          std::vector<Evidence>* evidence) {
  const AgreementFigure* worst = nullptr;
  for (const AgreementFigure& one : judged.agreement) {
    if (one.distance < kDoubtfulError * one.limit) continue;
    if (worst == nullptr ||
        one.distance / one.limit > worst->distance / worst->limit) {
      worst = &one;
    }
  }
  if (worst == nullptr) return;
  const double limit = kDoubtfulError * worst->limit;
  evidence->push_back(
      {.grade = Grade::kDoubtful,
       .what = fmt::format("at {:.1f} s {} by {:.1f} sigma "
                           "(limit {:.1f})",
                           worst->t, worst->what, worst->distance, limit),
       .value = worst->distance,
       .limit = limit,
       .unit = "sigma",
       .t_begin = worst->t,
       .t_end = worst->t});
}

}  // namespace hindsight
