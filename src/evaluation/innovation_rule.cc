#include "evaluation/innovation_rule.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "evaluation/contradicted_sensor.h"

namespace hindsight {
namespace {

/// Whether measurements were used, but of no sensor as many as a test takes.
bool AreTooFew(const Judged& judged) {
  if (judged.sensors.empty()) return false;
  std::vector<std::size_t> used(judged.sensors.size(), 0);
  for (const ResidualRecord& record : judged.solution.residuals) {
    if (!record.accepted || record.withheld) continue;
    ++used[static_cast<std::size_t>(record.sensor)];
  }
  const std::size_t most = *std::max_element(used.begin(), used.end());
  return most > 0 && most < kFewestInnovations;
}

}  // namespace

void FindOddInnovations(const Judged& judged, std::vector<Evidence>* evidence) {
  if (judged.untested) {
    evidence->push_back(
        {.grade = Grade::kDoubtful,
         .what = "whether the model fits could not be tested: linearised about "
                 "the solution no filter holds",
         .remedies = {"a start or noise that is nearer to the truth"}});
  }
  if (!judged.untested && AreTooFew(judged)) {
    evidence->push_back(
        {.grade = Grade::kDoubtful,
         .what = fmt::format("no sensor has the {} measurements that a test of "
                             "whether the model fits takes",
                             kFewestInnovations),
         .causes = {"a recording that is too short, or a clock that covers "
                    "little of it"},
         .remedies = {"a longer interval"}});
  }
  std::vector<const InnovationFigure*> worst(judged.sensors.size(), nullptr);
  for (const InnovationFigure& figure : judged.innovations) {
    const InnovationFigure*& own =
        worst[static_cast<std::size_t>(figure.sensor)];
    if (own == nullptr || figure.excess > own->excess) own = &figure;
  }
  for (const InnovationFigure* figure : worst) {
    if (figure == nullptr || figure->excess < kDoubtfulError) continue;
    const std::string& name =
        judged.sensors[static_cast<std::size_t>(figure->sensor)].name;
    const bool unusable = figure->excess >= kUnusableError &&
                          !judged.vouched_for && !IsOutvoted(judged, name);
    evidence->push_back(
        {.grade = unusable ? Grade::kUnusable : Grade::kDoubtful,
         .what = fmt::format(
             "over {:.1f} s the innovations of {} add up to {:.1f} times "
             "what their sigmas say",
             figure->duration, name, figure->excess),
         .value = figure->excess,
         .limit = unusable ? kUnusableError : kDoubtfulError,
         .unit = "sigma",
         .t_begin = figure->t_begin,
         .t_end = figure->t_end});
  }
}

}  // namespace hindsight
