#include "factors/measurement_factor.h"

namespace hindsight {
namespace {

/// The constants a measurement may depend on: those of its sensor, of the
/// vehicle it speaks of and the IMU's.
std::vector<int> GlobalsOf(const StateBlocks& blocks, const Timeline& timeline,
                           const Measurement& z) {
  const int vehicle =
      timeline.sensors()[static_cast<std::size_t>(z.sensor)].vehicle;
  std::vector<int> globals;
  for (const StateBlocks::Entry& entry : blocks.globals()) {
    const int sensor = entry.block.key.sensor;
    if (sensor == z.sensor || sensor == vehicle ||
        sensor == BlockKey::kNoSensor) {
      globals.push_back(entry.ambient);
    }
  }
  return globals;
}

}  // namespace

MeasurementFactor::MeasurementFactor(const StateBlocks* blocks,
                                     const Timeline* timeline, int k,
                                     const Measurement* z)
    : TangentFactor(blocks, Rows(*z), {k}, GlobalsOf(*blocks, *timeline, *z)),
      timeline_(*timeline),
      k_(static_cast<std::size_t>(k)),
      z_(*z) {}

double MeasurementFactor::NodeTime(int) const { return timeline_.node(k_).t; }

void MeasurementFactor::LinearizeStates(const std::vector<State>& states,
                                        Eigen::Map<Eigen::VectorXd> residual,
                                        Jacobian* J) const {
  const ErrorLayout& layout = blocks().layout();
  LinearizedMeasurement z;
  hindsight::Evaluate(z_, timeline_.Context(k_, z_, layout, states[0]), &z);
  residual = -z.residual;
  for (const StateBlocks::Entry& entry : blocks().entries()) {
    const int column = ColumnOf(entry, 0);
    if (J == nullptr || column < 0) continue;
    const int dim = entry.block.dim;
    J->middleCols(column, dim) = z.H.middleCols(entry.block.offset, dim);
  }
  Whiten(Whitener(z.R), residual, J);
}

}  // namespace hindsight
