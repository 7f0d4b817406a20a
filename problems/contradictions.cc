#include "problems/contradictions.h"

#include <cmath>
#include <cstdio>

namespace hindsight {
namespace {

constexpr double kStrained = 5.0;
constexpr double kSameTime = 1e-6;  // [s]

void AddStrains(const Prior& prior, const Solution& solution,
                std::vector<std::string>* found) {
  if (solution.states.empty()) return;
  const State& x = solution.states.front();
  if (std::abs(x.t - prior.x.t) > kSameTime ||
      solution.layout.dim() != prior.P.rows()) {
    return;
  }
  const ErrorVector d = Local(solution.layout, prior.x, x);
  for (int i = 0; i < solution.layout.dim(); ++i) {
    const double sigmas = std::abs(d(i)) / std::sqrt(prior.P(i, i));
    if (!(sigmas > kStrained)) continue;
    char text[160];
    std::snprintf(text, sizeof(text),
                  "%s at the start %.1f sigmas from its given value",
                  solution.layout.ComponentName(i).c_str(), sigmas);
    found->emplace_back(text);
  }
}

void AddRejections(const std::vector<Sensor>& sensors, const Solution& solution,
                   std::vector<std::string>* found) {
  std::vector<int> all(sensors.size(), 0);
  std::vector<int> rejected(sensors.size(), 0);
  for (const ResidualRecord& record : solution.residuals) {
    if (record.withheld) continue;
    const auto i = static_cast<std::size_t>(record.sensor);
    ++all[i];
    if (!record.accepted) ++rejected[i];
  }
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (2 * rejected[i] <= all[i]) continue;
    char text[160];
    std::snprintf(
        text, sizeof(text),
        "%d of %d measurements of %s beyond its gate and left them out",
        rejected[i], all[i], sensors[i].name.c_str());
    found->emplace_back(text);
  }
}

}  // namespace

std::vector<std::string> FindContradictions(const std::vector<Sensor>& sensors,
                                            const Prior& prior,
                                            const Solution& solution) {
  std::vector<std::string> found;
  AddStrains(prior, solution, &found);
  AddRejections(sensors, solution, &found);
  return found;
}

}  // namespace hindsight
