#include "io/constant_csv.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "io/atomic_file.h"
#include "io/number_format.h"
#include "io/time_scale.h"

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
    if (block.key.kind <= BlockKind::kAccelBias) continue;
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

}  // namespace

bool HasConstantSeries(const Solution& solution) {
  return solution.forward && !solution.covariances.empty() &&
         !ConstantComponents(solution.layout).empty();
}

void WriteConstantCsv(const std::string& path, const Solution& solution,
                      const std::string& program,
                      std::optional<std::int64_t> epoch_gps_ns) {
  constexpr std::size_t kMost = 5000;
  constexpr int kDigits = 9;
  const std::vector<ConstantComponent> components =
      ConstantComponents(solution.layout);
  AtomicFile file(path);
  file.Write("# program: " + program + "\n" + EpochComment(epoch_gps_ns));
  std::string line = "t[s]";
  for (const ConstantComponent& c : components) {
    line += ',' + c.name + '[' + c.unit + "],sd_" + c.name + '[' + c.unit + ']';
  }
  file.Write(line + "\n");
  const std::size_t n = solution.states.size();
  const std::size_t step = std::max<std::size_t>(1, (n + kMost - 1) / kMost);
  for (std::size_t k = 0; k < n; k += step) {
    const ErrorMatrix P = solution.covariances.Get(k);
    line.clear();
    AppendFixed(solution.states[k].t, 6, &line);
    for (const ConstantComponent& c : components) {
      line += ',';
      AppendGeneral(solution.states[k].parameters(c.parameter), kDigits, &line);
      line += ',';
      AppendGeneral(std::sqrt(P(c.error, c.error)), kDigits, &line);
    }
    line += '\n';
    file.Write(line);
  }
  file.Commit();
}

}  // namespace hindsight
