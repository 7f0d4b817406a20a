#include "io/write/constant_csv.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "io/read/time_scale.h"
#include "io/write/atomic_file.h"
#include "io/write/number_format.h"

namespace hindsight {
namespace {

struct ConstantComponent {
  std::string name;
  std::string unit;
  int parameter = 0;  ///< in State::parameters
  int error = 0;      ///< in the error vector
};

std::vector<ConstantComponent> ConstantComponents(const ErrorLayout& layout) {
  std::vector<ConstantComponent> components;
  for (const Block& block : layout.blocks()) {
    if (IsNavigation(block.key.kind)) continue;
    int error = block.offset;
    for (int axis = 0; axis < FullDimension(block.key.kind); ++axis) {
      if (!block.active[static_cast<std::size_t>(axis)]) continue;
      components.push_back({layout.ComponentName(error), block.unit,
                            block.parameter_offset + axis, error});
      ++error;
    }
  }
  return components;
}

/// One epoch: values and standard deviations in the order of the components.
void AppendRow(const std::vector<ConstantComponent>& components,
               const State& state, const ErrorVector& sigma,
               std::string* line) {
  constexpr int kDigits = 9;
  AppendFixed(state.t, 6, line);
  for (const ConstantComponent& c : components) {
    *line += ',';
    const bool known = std::isfinite(sigma(c.error));
    if (known) AppendGeneral(state.parameters(c.parameter), kDigits, line);
    *line += ',';
    if (known) AppendGeneral(sigma(c.error), kDigits, line);
  }
  *line += '\n';
}

/// What a backward filter alone knew; empty where there is none.
std::span<const OneSidedState> Backward(const Solution& solution) {
  if (!solution.two_filter) return {};
  return solution.two_filter->backward;
}

}  // namespace

bool HasConstantSeries(const Solution& solution) {
  const bool known = (solution.forward && !solution.covariances.empty()) ||
                     !Backward(solution).empty();
  return known && !ConstantComponents(solution.layout).empty();
}

void WriteConstantCsv(const std::string& path, const Solution& solution,
                      const std::string& program,
                      std::optional<std::int64_t> epoch_gps_ns) {
  constexpr std::size_t kMost = 5000;
  const std::vector<ConstantComponent> components =
      ConstantComponents(solution.layout);
  const std::span<const OneSidedState> backward = Backward(solution);
  AtomicFile file(path);
  std::string line =
      "# program: " + program + "\n" + EpochComment(epoch_gps_ns) +
      (backward.empty() ? "# as the filter knew them at each time\n"
                        : "# as the backward filter alone knew them, from "
                          "what came later\n") +
      "t[s]";
  for (const ConstantComponent& c : components) {
    line += ',' + c.name + '[' + c.unit + "],sd_" + c.name + '[' + c.unit + ']';
  }
  file.Write(line + "\n");
  for (const OneSidedState& side : backward) {
    line.clear();
    AppendRow(components, side.state, side.sigma, &line);
    file.Write(line);
  }
  const std::size_t n = backward.empty() ? solution.states.size() : 0;
  const std::size_t step = std::max<std::size_t>(1, (n + kMost - 1) / kMost);
  for (std::size_t k = 0; k < n; k += step) {
    line.clear();
    AppendRow(components, solution.states[k],
              solution.covariances.Variances(k).cwiseSqrt(), &line);
    file.Write(line);
  }
  file.Commit();
}

}  // namespace hindsight
