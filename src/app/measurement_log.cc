#include "app/measurement_log.h"

#include <fmt/core.h>
#include <glog/logging.h>

#include <string>

namespace hindsight {

void LogDownWeighted(const Dataset& dataset, const Solution& solution) {
  constexpr double kLittle = 0.5;
  for (const ResidualRecord& record : solution.residuals) {
    if (record.withheld) continue;
    if (record.accepted && record.weight >= kLittle) continue;
    std::string residual;
    for (Eigen::Index i = 0; i < record.residual.size(); ++i) {
      residual += fmt::format(" {:.4g}", record.residual(i));
      if (i < record.sigma.size()) {
        residual += fmt::format(" (sigma {:.3g})", record.sigma(i));
      }
    }
    const auto sensor = static_cast<std::size_t>(record.sensor);
    LOG(INFO) << fmt::format("{}: {} at {:.3f} s {}, residual{}, weight {:.3g}",
                             solution.method,
                             dataset.streams.at(sensor).sensor.name, record.t,
                             record.accepted ? "down-weighted" : "rejected",
                             residual, record.accepted ? record.weight : 0.0);
  }
}

}  // namespace hindsight
