#include "timeline/time_update.h"

#include "timeline/distance_link.h"

namespace hindsight {
namespace {

/// The timeline's step of a block over the interval, or nullptr.
const BlockStep* GivenStep(const NodeInterval& interval, const BlockKey& key) {
  for (const BlockStep& step : interval.timeline.StepsAfter(interval.k)) {
    if (step.key == key) return &step;
  }
  return nullptr;
}

/// The share of the timeline's interval that the summary covers.
double PartOfTime(const NodeInterval& interval) {
  const Timeline& timeline = interval.timeline;
  const double whole =
      timeline.node(interval.k + 1).t - timeline.node(interval.k).t;
  return interval.summary.dt() / whole;
}

const Block* RateOf(const ErrorLayout& layout, const BlockStep& step) {
  return step.rate ? layout.Find(step.rate->kind, step.rate->sensor) : nullptr;
}

void AdvanceGivenSteps(const ErrorLayout& layout, const NodeInterval& interval,
                       const State& x_i, State* x_j) {
  for (const BlockStep& whole : interval.timeline.StepsAfter(interval.k)) {
    const Block* block = layout.Find(whole.key.kind, whole.key.sensor);
    if (block == nullptr) continue;
    const BlockStep step = PartOf(whole, PartOfTime(interval));
    const int dim = FullDimension(step.key.kind);
    auto b = x_j->parameters.segment(block->parameter_offset, dim);
    b = step.phi * x_i.parameters.segment(block->parameter_offset, dim);
    if (const Block* rate = RateOf(layout, step)) {
      b += step.rate_share * interval.summary.dt() *
           x_i.parameters.segment(rate->parameter_offset, dim);
    }
  }
}

void LinearizeGivenSteps(const ErrorLayout& layout,
                         const NodeInterval& interval, const State& x_i,
                         const State& x_j, Transition* out) {
  const double dt = interval.summary.dt();
  for (const BlockStep& whole : interval.timeline.StepsAfter(interval.k)) {
    const Block* block = layout.Find(whole.key.kind, whole.key.sensor);
    if (block == nullptr) continue;
    const BlockStep step = PartOf(whole, PartOfTime(interval));
    const Block* rate = RateOf(layout, step);
    int component = block->offset;
    for (int axis = 0; axis < FullDimension(step.key.kind); ++axis) {
      if (!block->active[static_cast<std::size_t>(axis)]) continue;
      const int parameter = block->parameter_offset + axis;
      out->Phi(component, component) = step.phi;
      out->Q(component, component) = step.VarianceOf(axis);
      out->c(component) =
          step.phi * x_i.parameters(parameter) - x_j.parameters(parameter);
      if (rate != nullptr) {
        const double by = step.rate_share * dt;
        out->Phi(component, rate->offset + axis) = by;
        out->c(component) += by * x_i.parameters(rate->parameter_offset + axis);
      }
      ++component;
    }
  }
}

}  // namespace

NodeInterval IntervalAfter(std::size_t k, const ErrorLayout& layout,
                           const State& x, Timeline* timeline) {
  return {*timeline, k, timeline->Integrate(k, CalibrationOf(layout, x))};
}

BlockStep StepOf(const NodeInterval& interval, const Block& block,
                 double distance) {
  const BlockStep* given = GivenStep(interval, block.key);
  return given != nullptr
             ? PartOf(*given, PartOfTime(interval))
             : EvolutionStep(block, interval.summary.dt(), distance);
}

ImuLink::Matrix15 LinkNoise(const NodeInterval& interval) {
  const ImuSummary& summary = interval.summary;
  ImuLink::Matrix15 S = LinkNoise(summary);
  if (!interval.with_velocity_steps) return S;
  const VelocityStep::Noise noise =
      interval.timeline.VelocityNoise(summary.t_i, summary.t_j);
  for (int p = 0; p < 3; ++p) {
    const int v = 3 + p;
    S(p, p) += noise.pp;
    S(p, v) += noise.pv;
    S(v, p) += noise.pv;
    S(v, v) += noise.vv;
  }
  return S;
}

State Advance(const ErrorLayout& layout, const NodeInterval& interval,
              const State& x_i) {
  State x_j = Predict(layout, x_i, interval.summary);
  AdvanceGivenSteps(layout, interval, x_i, &x_j);
  PredictDistances(layout, interval.timeline, interval.k, x_i, &x_j);
  return x_j;
}

State AdvanceBeside(const State& navigation, const ErrorLayout& layout,
                    const NodeInterval& interval, const State& x_i) {
  State x_j = navigation;
  x_j.parameters = x_i.parameters;
  PredictParameters(layout, x_i, interval.summary.dt(), &x_j);
  AdvanceGivenSteps(layout, interval, x_i, &x_j);
  PredictDistances(layout, interval.timeline, interval.k, x_i, &x_j);
  return x_j;
}

void LinearizeAdvance(const ErrorLayout& layout, const NodeInterval& interval,
                      const State& x_i, const State& x_j, Transition* out) {
  LinearizeTransition(layout, interval.summary, LinkNoise(interval), x_i, x_j,
                      out);
  LinearizeGivenSteps(layout, interval, x_i, x_j, out);
  LinearizeDistances(layout, interval.timeline, interval.k, x_i, x_j, out);
}

}  // namespace hindsight
