#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "measurements/magnetic_field.h"
#include "measurements/sensor_kind.h"
#include "receiver_errors/error_states.h"
#include "receiver_errors/sensor_findings.h"
#include "receiver_errors/sensor_tape.h"

namespace hindsight {
namespace {

/// Root mean square of the stated sigmas of a sensor, of its first two rows; where its
/// errors are a field of the vehicle, of that.
double StatedSigma(const LinearTape& tape, int sensor) {
  const Block* own = OwnFieldOf(tape.layout(), sensor);
  double sum = 0.0;
  int count = 0;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    for (const TapeMeasurement& z : tape.measurements(k)) {
      if (z.sensor != sensor || !z.accepted || z.withheld) continue;
      for (Eigen::Index i = 0; i < std::min<Eigen::Index>(2, z.R.rows()); ++i) {
        const double by_field =
            own == nullptr
                ? 1.0
                : z.H.row(i).segment(own->offset, own->dim).squaredNorm();
        sum += z.R(i, i) / by_field;
        ++count;
      }
    }
  }
  return std::sqrt(sum / std::max(1, count));
}

/// Of a magnetometer the field in axes of the vehicle, or the azimuth of one whose hard
/// iron is known.
std::string UnitOf(const SensorKind& kind, int rows, bool is_own_field) {
  if (kind.magnetic) return rows == 1 && !is_own_field ? "rad" : "uT";
  return std::string(kind.residual_unit.empty() ? "SI" : kind.residual_unit);
}

/// Sensors of positions of which a fix is used.
std::set<int> UsedPositions(const Timeline& timeline, const LinearTape& tape) {
  std::set<int> used;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    for (const TapeMeasurement& z : tape.measurements(k)) {
      const auto sensor = static_cast<std::size_t>(z.sensor);
      if (z.accepted && !z.withheld &&
          timeline.sensors()[sensor].kind->is_position) {
        used.insert(z.sensor);
      }
    }
  }
  return used;
}

}  // namespace

std::size_t SensorOf(const ErrorDecisions& decisions) {
  return static_cast<std::size_t>(decisions.sensor);
}

bool HasRoomFor(const ErrorLayout& layout, int states) {
  return layout.parameter_count() + states <= kMaxParameters &&
         layout.dim() + states <= kMaxErrorDim;
}

bool HasOpenBias(const ErrorDecisions& decisions) {
  return decisions.open.has_value();
}

double ExtendByOpenBias(const ErrorDecisions& decisions, const LinearTape& tape,
                        Problem* problem) {
  if (!HasOpenBias(decisions) ||
      problem->layout.Has(BlockKind::kSensorError, decisions.sensor)) {
    return 0.0;
  }
  WeighedHypothesis throughout;
  throughout.parameters = decisions.open->expected;
  throughout.steps.assign(tape.size(), {.mode = ErrorMode::kBiased});
  throughout.steps.front().anew = true;
  ErrorStates(tape, decisions.sensor, decisions.stated_sigma, decisions.unit,
              ErrorRegimes::Kind::kGaussMarkov, throughout)
      .AddError(problem);
  return decisions.open->Probability();
}

ErrorDecisions::ErrorDecisions(const Problem& problem, const LinearTape& tape,
                               int index)
    : sensor(index),
      name(problem.timeline.sensors()[static_cast<std::size_t>(index)].name),
      unit(UnitOf(
          *problem.timeline.sensors()[static_cast<std::size_t>(index)].kind,
          RowsOf(tape, index), OwnFieldOf(problem.layout, index) != nullptr)),
      stated_sigma(StatedSigma(tape, index)),
      is_tolerance(problem.timeline.sensors()[static_cast<std::size_t>(index)]
                       .kind->generated) {
  const std::set<int> positions = UsedPositions(problem.timeline, tape);
  alone = positions.contains(index) && positions.size() == 1;
  if (!positions.contains(index) || positions.size() != 2) return;
  const int other =
      *positions.begin() == index ? *positions.rbegin() : *positions.begin();
  beside = problem.timeline.sensors()[static_cast<std::size_t>(other)].name;
}

}  // namespace hindsight
