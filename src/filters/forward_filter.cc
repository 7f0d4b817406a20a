#include "filters/forward_filter.h"

#include <utility>

#include "filters/forward_pass.h"

namespace hindsight {
namespace {

LinearTape RunAlone(const ForwardModel& model, const ImmOptions& options,
                    Problem* problem, const EpochCallback& callback) {
  ForwardPass pass({{problem->layout, problem->prior}}, model, options,
                   problem->decisions, &problem->timeline);
  pass.Run(callback);
  return std::move(pass.TakeTapes().front());
}

}  // namespace

LinearTape RunForwardFilter(const ForwardModel& model, Problem* problem,
                            const EpochCallback& callback) {
  ImmOptions options;
  options.nominal = model.start;
  return RunAlone(model, options, problem, callback);
}

LinearTape RunExtendedKalmanFilter(Problem* problem,
                                   const EpochCallback& callback) {
  return RunForwardFilter({}, problem, callback);
}

LinearTape RunLinearizedFilter(std::span<const State> nominal, Problem* problem,
                               const EpochCallback& callback) {
  ImmOptions options;
  options.nominal = nominal;
  return RunAlone({}, options, problem, callback);
}

}  // namespace hindsight
