#include "problems/deviation_columns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <variant>

#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

/// Constants that a sensor may have without having been asked for.
constexpr std::array kTried = {BlockKind::kScale,    BlockKind::kMounting,
                               BlockKind::kLeverArm, BlockKind::kTimeOffset,
                               BlockKind::kHardIron, BlockKind::kDeclination};

bool IsTried(BlockKind kind) {
  return std::find(kTried.begin(), kTried.end(), kind) != kTried.end();
}

/// What is measured in navigation axes, NED, positions from the first one.
std::optional<Eigen::Vector3d> NavigationValue(
    const MeasurementModel& model, const Eigen::Vector3d& origin_e) {
  if (const auto* z = std::get_if<PositionFix>(&model)) {
    return NedAxes(z->p_e).transpose() * (z->p_e - origin_e);
  }
  if (const auto* z = std::get_if<VelocityFix>(&model)) return z->v_n;
  return std::nullopt;
}

/// What one more of a component adds to a measurement.
Eigen::VectorXd UnitOf(int component, const Measurement& z) {
  Eigen::VectorXd unit = Eigen::VectorXd::Zero(Rows(z));
  for (int row = 0; row < unit.size(); ++row) {
    if (ComponentOf(z, row) == component) unit(row) = 1.0;
  }
  return unit;
}

/// States of a sensor that are added to what it measures of the motion.
constexpr std::array kAdded = {BlockKind::kColouredNoise,
                               BlockKind::kSensorError};

/// The state of a sensor without errors that are added.
void TakeOutErrors(int sensor, const ErrorLayout& layout, State* x) {
  for (const BlockKind kind : kAdded) {
    const Block* block = layout.Find(kind, sensor);
    if (block == nullptr) continue;
    x->parameters.segment(block->parameter_offset, FullDimension(kind))
        .setZero();
  }
}

bool Fits(const ErrorLayout& layout, BlockKind kind) {
  const int dim = FullDimension(kind);
  return layout.dim() + dim <= kMaxErrorDim &&
         layout.parameter_count() + dim <= kMaxParameters;
}

}  // namespace

DeviationColumns::DeviationColumns(const Problem& problem,
                                   const std::vector<State>& states,
                                   const LinearTape& tape)
    : problem_(problem), states_(states), tape_(tape) {
  const Timeline& timeline = problem.timeline;
  const std::vector<Measurement>& all = timeline.all_measurements();
  std::vector<const Measurement*> first(timeline.sensors().size(), nullptr);
  std::vector<int> components(first.size(), 0);
  for (const Measurement& z : all) {
    const auto sensor = static_cast<std::size_t>(z.sensor);
    if (first[sensor] == nullptr) first[sensor] = &z;
    components[sensor] =
        std::max(components[sensor], ComponentOf(z, Rows(z) - 1) + 1);
  }
  for (std::size_t i = 0; i < first.size(); ++i) {
    sensors_.push_back(first[i] == nullptr ? OfSensor{}
                                           : Plan(static_cast<int>(i),
                                                  *first[i], components[i]));
  }
  untold_.assign(ImuDeviations().size(), 0.0);
  if (problem.layout.has_canonical_head()) {
    FollowTurns();
    FollowNoise();
  }
}

DeviationColumns::OfSensor DeviationColumns::Plan(int sensor,
                                                  const Measurement& first,
                                                  int components) const {
  using Kind = Deviation::Kind;
  OfSensor plan;
  plan.layout = problem_.layout;
  const auto* odometer = std::get_if<Odometer>(&first.model);
  plan.has_clock =
      odometer == nullptr || odometer->form != Odometer::Form::kIncrements;
  const Sensor& rig =
      problem_.timeline.sensors()[static_cast<std::size_t>(sensor)];
  std::vector<double> values;
  for (const SensorBlock& declared : rig.kind->blocks) {
    if (!IsTried(declared.kind) || plan.layout.Has(declared.kind, sensor) ||
        !Fits(plan.layout, declared.kind) ||
        (declared.kind == BlockKind::kTimeOffset && !plan.has_clock)) {
      continue;
    }
    Block block;
    block.key = {declared.kind, sensor};
    plan.layout.Add(block);
    const Eigen::Vector3d value = declared.value == nullptr
                                      ? Eigen::Vector3d::Zero()
                                      : declared.value(rig);
    for (int axis = 0; axis < FullDimension(declared.kind); ++axis) {
      values.push_back(value(axis));
      plan.deviations.push_back(
          {.kind = Kind::kBlock,
           .block = declared.kind,
           .axis = axis,
           .may_begin_late = declared.kind == BlockKind::kTimeOffset ||
                             declared.kind == BlockKind::kScale ||
                             declared.kind == BlockKind::kLeverArm});
    }
  }
  plan.parameters.resize(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), plan.parameters.begin());
  if (const auto* fix = std::get_if<PositionFix>(&first.model)) {
    plan.origin_e = fix->p_e;
  }
  if (NavigationValue(first.model, plan.origin_e)) {
    for (int axis = 0; axis < 3; ++axis) {
      plan.deviations.push_back({.kind = Kind::kTurned, .axis = axis});
    }
    plan.deviations.push_back({.kind = Kind::kStretched});
  }
  for (int axis = 0; axis < components; ++axis) {
    plan.deviations.push_back(
        {.kind = Kind::kAdditive, .axis = axis, .may_begin_late = true});
  }
  return plan;
}

std::vector<ShiftColumns::Columns> DeviationColumns::Measured(
    std::size_t k, const TapeMeasurement& z) const {
  const OfSensor& own = sensors_[static_cast<std::size_t>(z.sensor)];
  const auto count = static_cast<Eigen::Index>(own.deviations.size());
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(z.H.rows(), count);
  State x = states_[k];
  x.parameters.conservativeResize(own.layout.parameter_count());
  x.parameters.tail(own.parameters.size()) = own.parameters;
  TakeOutErrors(z.sensor, problem_.layout, &x);
  const Measurement& measured =
      problem_.timeline.measurements(k)[static_cast<std::size_t>(z.index)];
  ModelContext context = problem_.timeline.Context(k, measured, own.layout, x);
  context.offset_rate = nullptr;
  LinearizedMeasurement linear;
  Evaluate(measured, context, &linear);
  const RowVector rate = own.has_clock ? TimeOffsetRate(measured, context)
                                       : RowVector::Zero(B.rows()).eval();
  // As predicted, without errors of its own that are estimated: the noise of what is
  // measured, and with it these, are in the innovation too.
  std::optional<Eigen::Vector3d> v =
      NavigationValue(measured.model, own.origin_e);
  if (v) *v -= linear.residual;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Deviation& deviation = own.deviations[static_cast<std::size_t>(i)];
    switch (deviation.kind) {
      case Deviation::Kind::kAdditive:
        B.col(i) = UnitOf(deviation.axis, measured);
        break;
      case Deviation::Kind::kTurned:
        B.col(i) = Eigen::Vector3d::Unit(deviation.axis).cross(*v);
        break;
      case Deviation::Kind::kStretched:
        B.col(i) = *v;
        break;
      case Deviation::Kind::kBlock:
        B.col(i) =
            deviation.block == BlockKind::kTimeOffset
                ? Eigen::VectorXd(rate)
                : Eigen::VectorXd(linear.H.col(
                      own.layout.Find(deviation.block, z.sensor)->offset +
                      deviation.axis));
        break;
    }
  }
  return {{.group = z.sensor, .B = std::move(B)},
          {.group = kAllClocks, .B = rate}};
}

ShiftColumns DeviationColumns::Columns() const {
  return {[this](std::size_t k, const TapeMeasurement& z) {
            return Measured(k, z);
          },
          [this](std::size_t k) { return Driven(k); }};
}

ShiftColumns DeviationColumns::Additive() const {
  return {[this](std::size_t k, const TapeMeasurement& z) {
    const Measurement& measured =
        problem_.timeline.measurements(k)[static_cast<std::size_t>(z.index)];
    Eigen::MatrixXd B(z.H.rows(), 0);
    for (const Deviation& one : Of(z.sensor)) {
      if (one.kind != Deviation::Kind::kAdditive) continue;
      B.conservativeResize(Eigen::NoChange, B.cols() + 1);
      B.rightCols(1) = UnitOf(one.axis, measured);
    }
    return std::vector<ShiftColumns::Columns>{
        {.group = z.sensor, .B = std::move(B)}};
  }};
}

}  // namespace hindsight
