#include "filters/forward_pass.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "filters/transport.h"

namespace hindsight {
namespace {

/// `to` with the navigation state of `from`.
State WithNavigationOf(const State& from, State to) {
  to.t = from.t;
  to.p_e = from.p_e;
  to.v_e = from.v_e;
  to.q_eb = from.q_eb;
  to.b_g = from.b_g;
  to.b_a = from.b_a;
  return to;
}

std::vector<const ErrorLayout*> LayoutsOf(
    const std::vector<PassModel>& models) {
  if (models.empty()) throw std::logic_error("an IMM needs a model");
  std::vector<const ErrorLayout*> layouts;
  for (const PassModel& model : models) layouts.push_back(&model.layout);
  return layouts;
}

}  // namespace

ForwardPass::ForwardPass(const std::vector<PassModel>& models,
                         const ForwardModel& model, const ImmOptions& options,
                         const GateDecisions& decisions, Timeline* timeline)
    : options_(options),
      timeline_(*timeline),
      rule_(*timeline, decisions),
      error_(model.error),
      modes_(options, LayoutsOf(models)),
      masks_vertical_(MasksVertical(models.front().layout)) {
  filters_.reserve(models.size());
  for (const PassModel& one : models) {
    filters_.push_back({one,
                        WithNavigationOf(models.front().prior.x, one.prior.x),
                        {},
                        CovariancePolicy(model.covariance, one.layout),
                        LinearTape(one.layout, model.error),
                        {},
                        {}});
    errors_.push_back({ErrorVector::Zero(one.layout.dim()), one.prior.P});
    Filter& f = filters_.back();
    f.transition.c = errors_.back().mean;
    f.tape.Reserve(timeline->size());
    if (!f.policy.is_kalman()) f.tape.ForbidSmoothing();
  }
  rule_.Suppose(model.supposition);
  if (IsAboutFixed(0)) StartAbout(options.nominal.front());
  if (filters_.size() == 1 && !masks_vertical_) {
    fixed_.emplace(filters_.front().model.layout, options.nominal, timeline);
  }
}

void ForwardPass::Record(ImmResult* result) {
  result_ = result;
  result->tape.transition = options_.transition;
  result->trajectory.P =
      CovarianceSeries(filters_.front().model.layout.dim(), timeline_.size());
}

void ForwardPass::Run(const EpochCallback& callback) {
  for (std::size_t k = 0; k < timeline_.size(); ++k) {
    if (k > 0) PredictTo(k);
    UpdateAt(k);
    if (callback) callback(k + 1);
  }
}

std::vector<LinearTape> ForwardPass::TakeTapes() {
  std::vector<LinearTape> tapes;
  for (Filter& f : filters_) {
    f.tape.SetBound(f.policy.record());
    tapes.push_back(std::move(f.tape));
  }
  return tapes;
}

bool ForwardPass::MaySwitch(std::size_t k) const {
  const std::vector<int>& named = options_.sensors;
  const auto measurements = timeline_.measurements(k);
  return std::any_of(
      measurements.begin(), measurements.end(), [&](const Measurement& z) {
        return !z.withheld &&
               (named.empty() ||
                std::find(named.begin(), named.end(), z.sensor) != named.end());
      });
}

/// Expresses the priors about another nominal: their means become errors, their
/// covariances move into the new tangent.
void ForwardPass::StartAbout(const State& nominal) {
  for (std::size_t j = 0; j < filters_.size(); ++j) {
    Filter& f = filters_[j];
    const ErrorLayout& layout = f.model.layout;
    if (nominal.parameters.size() != layout.parameter_count()) {
      throw std::logic_error("parameters of the nominal are not the models'");
    }
    errors_[j].mean = Local(layout, nominal, f.x);
    MoveCovariance(Transport(layout, f.x, nominal), &errors_[j].P);
    f.x = nominal;
  }
}

/// From one node of the fixed nominal to the next.
void ForwardPass::PredictAlong(std::size_t k) {
  Filter& f = filters_.front();
  Gaussian& error = errors_.front();
  const FixedTransitions::Step& step = fixed_->To(k);
  f.transition = step.transition;
  error.mean = (f.transition.Phi * error.mean + f.transition.c).eval();
  f.policy.Predict(f.transition, step.dt, &error.P);
  f.x = options_.nominal[k];
}

/// Mixes, if the mode may switch at node k, and predicts (Baek 2019, eq. (8)).
void ForwardPass::PredictTo(std::size_t k) {
  epoch_.switched = MaySwitch(k);
  if (epoch_.switched) modes_.Switch(&errors_);
  if (fixed_ && IsAboutFixed(k)) {
    PredictAlong(k);
    return;
  }
  for (std::size_t j = 0; j < filters_.size(); ++j) {
    Filter& f = filters_[j];
    const NodeInterval interval =
        IntervalAfter(k - 1, f.model.layout, f.x, &timeline_);
    State nominal = Nominal(k, j, interval);
    LinearizeAdvance(f.model.layout, interval, f.x, nominal, &f.transition);
    // The nominal is what the first model predicts, so that its defect is zero
    // but for rounding.
    if (!IsAboutFixed(k) && j == 0) f.transition.c.setZero();
    Gaussian& error = errors_[j];
    error.mean = (f.transition.Phi * error.mean + f.transition.c).eval();
    f.policy.Predict(f.transition, interval.summary.dt(), &error.P);
    f.x = std::move(nominal);
  }
}

State ForwardPass::Nominal(std::size_t k, std::size_t j,
                           const NodeInterval& interval) {
  if (IsAboutFixed(k)) return options_.nominal[k];
  const Filter& f = filters_[j];
  return j == 0 ? Advance(f.model.layout, interval, f.x)
                : AdvanceBeside(filters_[0].x, f.model.layout, interval, f.x);
}

void ForwardPass::OverwriteVertical(std::size_t k) {
  State& first = filters_.front().x;
  vertical_.Overwrite(timeline_, k, filters_.front().model.layout, &first);
  for (Filter& f : filters_) f.x = WithNavigationOf(first, f.x);
}

}  // namespace hindsight
