#include "measurements/timeline.h"

#include <algorithm>
#include <utility>

namespace hindsight {

Timeline::Timeline(std::vector<Node> nodes,
                   std::vector<Measurement> measurements,
                   std::vector<Sensor> sensors, const ImuStream& imu,
                   bool with_scale_jacobians)
    : nodes_(std::move(nodes)),
      measurements_(std::move(measurements)),
      sensors_(std::move(sensors)),
      integrator_(imu, with_scale_jacobians),
      summaries_(nodes_.empty() ? 0 : nodes_.size() - 1),
      integrated_(summaries_.size(), 0) {
  for (Node& node : nodes_) node.kinematics = integrator_.ReadingAt(node.t);
}

const IncrementStart* Timeline::IncrementStartAt(std::size_t k,
                                                 int sensor) const {
  const int node = static_cast<int>(k);
  auto it = std::lower_bound(
      increment_starts_.begin(), increment_starts_.end(), node,
      [](const IncrementStart& start, int n) { return start.node < n; });
  for (; it != increment_starts_.end() && it->node == node; ++it) {
    if (it->sensor == sensor) return &*it;
  }
  return nullptr;
}

const ImuSummary& Timeline::Summary(std::size_t k,
                                    const ImuCalibration& calibration) {
  if (integrated_[k] == 0 || NeedsReintegration(summaries_[k], calibration)) {
    summaries_[k] =
        integrator_.Summarize(nodes_[k].t, nodes_[k + 1].t, calibration);
    integrated_[k] = 1;
    if (!coloured_steps_.empty()) summaries_[k].coloured = coloured_steps_[k];
  }
  return summaries_[k];
}

void Timeline::SetColouredSteps(std::vector<ColouredStep> steps) {
  coloured_steps_ = std::move(steps);
  for (std::size_t k = 0; k < summaries_.size(); ++k) {
    summaries_[k].coloured =
        coloured_steps_.empty() ? ColouredStep{} : coloured_steps_[k];
  }
}

void Timeline::ScaleSensor(int sensor, double factor) {
  for (Measurement& z : measurements_) {
    if (z.sensor == sensor) ScaleSigma(factor, &z);
  }
}

bool Timeline::HasGates() const {
  return std::any_of(
      sensors_.begin(), sensors_.end(),
      [](const Sensor& sensor) { return sensor.gate_probability.has_value(); });
}

}  // namespace hindsight
