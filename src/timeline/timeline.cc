#include "timeline/timeline.h"

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
      summaries_(nodes_.empty() ? 0 : nodes_.size() - 1) {
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

const ImuSummary& Timeline::Integrate(std::size_t k,
                                      const ImuCalibration& calibration) {
  std::shared_ptr<const ImuSummary>& present = summaries_[k];
  if (present == nullptr || NeedsReintegration(*present, calibration)) {
    present = std::make_shared<const ImuSummary>(
        integrator_.Summarize(nodes_[k].t, nodes_[k + 1].t, calibration));
  }
  return *present;
}

namespace {

/// What the IMU reads on average within 25 ms of t. The rate of a prediction
/// stands for the motion over the whole uncertainty of a time offset; the noise
/// and vibration of a single reading are no part of that.
Kinematics MeanReading(double t, ImuIntegrator* integrator) {
  constexpr int kHalf = 5;
  constexpr double kStep = 0.005;
  Kinematics mean;
  for (int i = -kHalf; i <= kHalf; ++i) {
    const Kinematics k = integrator->ReadingAt(t + i * kStep);
    mean.w_ib_b += k.w_ib_b / (2 * kHalf + 1);
    mean.f_b += k.f_b / (2 * kHalf + 1);
  }
  return mean;
}

}  // namespace

void Timeline::LinearizeTimeOffsets(const ErrorLayout& layout,
                                    std::span<const State> states) {
  TimeOffsetRates rates;
  rates.measurements.resize(measurements_.size());
  for (std::size_t k = 0; k < size(); ++k) {
    for (const Measurement& z : measurements(k)) {
      if (!layout.Has(BlockKind::kTimeOffset, z.sensor)) continue;
      const Kinematics mean = MeanReading(nodes_[k].t, &integrator_);
      rates.measurements[static_cast<std::size_t>(&z - measurements_.data())] =
          TimeOffsetRate(
              z, {layout, states[k], mean,
                  sensors_[static_cast<std::size_t>(z.sensor)], z.sensor, z.t});
    }
  }
  for (const IncrementStart& start : increment_starts_) {
    std::optional<double>& rate = rates.increment_starts.emplace_back();
    if (!layout.Has(BlockKind::kTimeOffset, start.sensor)) continue;
    const auto k = static_cast<std::size_t>(start.node);
    rate = PredictedSpeed({layout, states[k], nodes_[k].kinematics,
                           sensors_[static_cast<std::size_t>(start.sensor)],
                           start.sensor, start.stamp});
  }
  SetTimeOffsetRates(std::move(rates));
}

void Timeline::SetTimeOffsetRates(TimeOffsetRates rates) {
  offset_rates_ = std::move(rates);
  for (std::size_t i = 0; i < increment_starts_.size(); ++i) {
    increment_starts_[i].offset_rate = offset_rates_.increment_starts[i];
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
