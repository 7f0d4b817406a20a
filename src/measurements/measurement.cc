#include "measurements/measurement.h"

namespace hindsight {

int Rows(const Measurement& z) {
  return std::visit([](const auto& model) { return model.rows(); }, z.model);
}

int ComponentOf(const Measurement& z, int row) {
  return std::visit(
      [row](const auto& model) {
        if constexpr (requires { model.Component(row); }) {
          return model.Component(row);
        } else {
          return row;
        }
      },
      z.model);
}

void ScaleSigma(double factor, Measurement* z) {
  std::visit([factor](auto& model) { model.ScaleSigma(factor); }, z->model);
}

namespace {

void EvaluateAtState(const Measurement& z, const ModelContext& context,
                     LinearizedMeasurement* out) {
  std::visit([&](const auto& model) { model.Evaluate(context, out); }, z.model);
}

const Block* TimeOffsetOf(const ModelContext& context) {
  return context.layout.Find(BlockKind::kTimeOffset, context.sensor_index);
}

/// Whether a measurement sees kColouredNoise of its sensor: those that tell a position,
/// velocity, height, course or heading by themselves.
bool SeesColouredNoise(const Measurement& z) {
  return std::holds_alternative<PositionFix>(z.model) ||
         std::holds_alternative<VelocityFix>(z.model) ||
         std::holds_alternative<HeightFix>(z.model) ||
         std::holds_alternative<SpeedCourse>(z.model) ||
         std::holds_alternative<GenericReading>(z.model);
}

/// Whether it sees kSensorError, along its rows: the same, wheels and DVLs. A magnetic field
/// knows its own error (measurements/magnetic_field.h).
bool SeesError(const Measurement& z) {
  return SeesColouredNoise(z) || std::holds_alternative<Odometer>(z.model) ||
         std::holds_alternative<Dvl>(z.model);
}

/// Takes an error of the sensor's own out of the prediction, an axis a row.
void TakeError(BlockKind kind, const ModelContext& context,
               LinearizedMeasurement* out) {
  const Block* error = context.layout.Find(kind, context.sensor_index);
  if (error == nullptr) return;
  int column = error->offset;
  for (int axis = 0; axis < out->residual.size() && axis < 3; ++axis) {
    if (!error->active[static_cast<std::size_t>(axis)]) continue;
    out->residual(axis) -=
        context.state.parameters(error->parameter_offset + axis);
    out->H(axis, column++) += 1.0;
  }
}

}  // namespace

void Evaluate(const Measurement& z, const ModelContext& context,
              LinearizedMeasurement* out) {
  EvaluateAtState(z, context, out);
  if (SeesColouredNoise(z)) {
    TakeError(BlockKind::kColouredNoise, context, out);
  }
  if (SeesError(z)) TakeError(BlockKind::kSensorError, context, out);
  const Block* offset = TimeOffsetOf(context);
  if (offset == nullptr) return;
  auto column = out->H.col(offset->offset);
  if (context.offset_rate == nullptr) {
    const RowVector scatter = offset->sigma0(0) * column;
    out->R += scatter * scatter.transpose();
    column.setZero();
    return;
  }
  const State& x = context.state;
  const double dt =
      context.stamp + x.parameters(offset->parameter_offset) - x.t;
  out->residual -= dt * *context.offset_rate;
  column = *context.offset_rate;
}

RowVector TimeOffsetRate(const Measurement& z, const ModelContext& context) {
  const Block* offset = TimeOffsetOf(context);
  if (offset == nullptr) return RowVector::Zero(Rows(z));
  LinearizedMeasurement at;
  EvaluateAtState(z, context, &at);
  return at.H.col(offset->offset);
}

}  // namespace hindsight
