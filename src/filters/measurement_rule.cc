#include "filters/measurement_rule.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>

#include "base/chi_square.h"

namespace hindsight {
namespace {

constexpr double kLeastWeight = 1e-9;

}  // namespace

double GateLimit(const Sensor& sensor, int rows) {
  if (!sensor.gate_probability) {
    return std::numeric_limits<double>::infinity();
  }
  return ChiSquareQuantile(*sensor.gate_probability, rows);
}

MeasurementRule::MeasurementRule(const Timeline& timeline,
                                 const GateDecisions& decisions)
    : timeline_(timeline), decisions_(decisions) {
  for (const Sensor& sensor : timeline.sensors()) {
    auto& limits = gate_limits_.emplace_back();
    for (int rows = 1; rows <= kMaxRows; ++rows) {
      limits[static_cast<std::size_t>(rows - 1)] = GateLimit(sensor, rows);
    }
  }
}

bool MeasurementRule::MayUse(std::size_t k, int index) const {
  const auto i = static_cast<std::size_t>(index);
  if (timeline_.measurements(k)[i].withheld) return false;
  return decisions_.empty() ||
         decisions_[static_cast<std::size_t>(
             timeline_.node(k).first_measurement + index)] != 0;
}

bool MeasurementRule::AsksTheInnovation(int sensor) const {
  const Sensor& s = timeline_.sensors()[static_cast<std::size_t>(sensor)];
  return s.loss.kind != RobustLoss::Kind::kNone ||
         (decisions_.empty() && s.gate_probability.has_value());
}

MeasurementVerdict MeasurementRule::Judge(std::size_t k, int index,
                                          const ErrorVector& dx,
                                          const ErrorMatrix& P,
                                          LinearizedMeasurement* z,
                                          Innovation* innovation) const {
  const Measurement& measurement =
      timeline_.measurements(k)[static_cast<std::size_t>(index)];
  const RobustLoss loss =
      timeline_.sensors()[static_cast<std::size_t>(measurement.sensor)]
          .loss.OfRows(static_cast<int>(z->residual.size()));
  MeasurementVerdict verdict;
  *innovation = Innovate(*z, dx, P);
  if (loss.kind != RobustLoss::Kind::kNone && !measurement.withheld) {
    verdict.weight =
        std::max(loss.Weight(RobustArgument(*z, *innovation)), kLeastWeight);
    z->R /= verdict.weight;
    *innovation = Innovate(*z, dx, P);
  }
  verdict.accepted =
      MayUse(k, index) && Passes(measurement.sensor, *innovation);
  return verdict;
}

double MeasurementRule::RobustArgument(const LinearizedMeasurement& z,
                                       const Innovation& innovation) const {
  if (!fixed_nominal_) return innovation.nis;
  return Eigen::LLT<RowMatrix>(z.R).matrixL().solve(z.residual).squaredNorm();
}

/// Whether the gate lets a measurement pass; all do where decisions are given.
bool MeasurementRule::Passes(int sensor, const Innovation& innovation) const {
  if (!decisions_.empty()) return true;
  if (sensor == supposition_.sensor && !supposition_.IsDecisive(innovation.S)) {
    return false;
  }
  const auto rows = static_cast<std::size_t>(innovation.residual.size());
  return innovation.nis <=
         gate_limits_[static_cast<std::size_t>(sensor)][rows - 1];
}

}  // namespace hindsight
