#include "evaluation/residual_statistics.h"

#include <cmath>

namespace hindsight {

std::vector<ResidualStatistics> ComputeResidualStatistics(
    const Solution& solution, const Dataset& dataset) {
  std::vector<ResidualStatistics> all(dataset.streams.size());
  std::vector<double> sums(dataset.streams.size(), 0.0);
  std::vector<double> weights(dataset.streams.size(), 0.0);
  for (const ResidualRecord& record : solution.residuals) {
    const auto sensor = static_cast<std::size_t>(record.sensor);
    ResidualStatistics& s = all.at(sensor);
    if (record.withheld) {
      ++s.withheld;
      continue;
    }
    ++s.count;
    if (!record.accepted) {
      ++s.rejected;
      continue;
    }
    sums[sensor] += record.weight * record.nis;
    weights[sensor] +=
        record.weight * static_cast<double>(record.residual.size());
  }
  std::vector<ResidualStatistics> present;
  for (std::size_t i = 0; i < all.size(); ++i) {
    ResidualStatistics& s = all[i];
    if (s.count + s.withheld == 0) continue;
    s.sensor = dataset.streams[i].sensor.name;
    s.kind = dataset.streams[i].sensor.kind;
    if (weights[i] > 0.0) {
      s.normalized_rms = std::sqrt(sums[i] / weights[i]);
    }
    present.push_back(s);
  }
  return present;
}

}  // namespace hindsight
