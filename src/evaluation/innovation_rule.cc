#include "evaluation/innovation_rule.h"

#include <fmt/core.h>

#include <cmath>
#include <utility>

#include "evaluation/contradicted_sensor.h"

namespace hindsight {

void FindOddInnovations(const Judged& judged, std::vector<Evidence>* evidence) {
  if (judged.untested) {
    evidence->push_back(
        {.grade = Grade::kDoubtful,
         .what = "whether the model fits could not be tested: linearised about "
                 "the solution no filter holds",
         .remedies = {"a start or noise that is nearer to the truth"}});
  }
  std::vector<const InnovationFigure*> worst(judged.sensors.size(), nullptr);
  for (const InnovationFigure& figure : judged.innovations) {
    const InnovationFigure*& own =
        worst[static_cast<std::size_t>(figure.sensor)];
    if (own == nullptr || figure.excess > own->excess) own = &figure;
  }
  const double wrong = std::hypot(1.0, kUnusableBias);
  for (const InnovationFigure* figure : worst) {
    if (figure == nullptr || figure->excess < kDoubtfulError) continue;
    const std::string& name =
        judged.sensors[static_cast<std::size_t>(figure->sensor)].name;
    const bool unusable = figure->excess >= wrong && !IsOutvoted(judged, name);
    evidence->push_back(
        {.grade = unusable ? Grade::kUnusable : Grade::kDoubtful,
         .what = fmt::format(
             "over {:.1f} s the innovations of {} add up to {:.1f} times "
             "what their sigmas say",
             figure->duration, name, figure->excess),
         .value = figure->excess,
         .limit = unusable ? wrong : kDoubtfulError,
         .unit = "sigma",
         .t_begin = figure->t_begin,
         .t_end = figure->t_end});
  }
}

}  // namespace hindsight
