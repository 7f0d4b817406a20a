#include "app/measurement_log.h"

#include <glog/logging.h>

#include <string>

#include "base/text.h"

namespace hindsight {

void LogDownWeighted(const Dataset& dataset, const Solution& solution) {
  constexpr double kLittle = 0.5;
  for (const ResidualRecord& record : solution.residuals) {
    if (record.withheld) continue;
    if (record.accepted && record.weight >= kLittle) continue;
    std::string residual;
    for (Eigen::Index i = 0; i < record.residual.size(); ++i) {
      residual += Format(" %.4g", record.residual(i));
      if (i < record.sigma.size()) {
        residual += Format(" (sigma %.3g)", record.sigma(i));
      }
    }
    const auto sensor = static_cast<std::size_t>(record.sensor);
    LOG(INFO) << Format(
        "%s: %s at %.3f s %s, residual%s, weight %.3g", solution.method.c_str(),
        dataset.streams.at(sensor).sensor.name.c_str(), record.t,
        record.accepted ? "down-weighted" : "rejected", residual.c_str(),
        record.accepted ? record.weight : 0.0);
  }
}

}  // namespace hindsight
