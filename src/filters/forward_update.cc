#include <string>
#include <utility>

#include "base/error.h"
#include "filters/forward_pass.h"
#include "filters/transport.h"

namespace hindsight {
namespace {

double FactorOf(const PassModel& model, int sensor) {
  return model.sigma_factors.empty()
             ? 1.0
             : model.sigma_factors[static_cast<std::size_t>(sensor)];
}

}  // namespace

double ForwardPass::StepTo(std::size_t k) const {
  return timeline_.node(k).t - timeline_.node(k - 1).t;
}

/// Updates every model (Baek 2019, eqs. (9) to (11)), combines them (eq. (12))
/// and writes the tapes.
void ForwardPass::UpdateAt(std::size_t k) {
  if (result_ != nullptr) epoch_.predicted = modes_.probability();
  if (masks_vertical_) OverwriteVertical(k);
  rule_.SetAboutFixedNominal(IsAboutFixed(k));
  BeginEpochs(k);
  modes_.BeginUpdate();
  const auto count = static_cast<int>(timeline_.measurements(k).size());
  for (int i = 0; i < count; ++i) Use(k, i);
  for (std::size_t j = 0; j < filters_.size(); ++j) {
    Filter& f = filters_[j];
    Gaussian& error = errors_[j];
    if (k > 0) f.policy.Bound(f.epoch.t, StepTo(k), &error.mean, &error.P);
    f.epoch.dx_plus = error.mean;
  }
  const bool resets = options_.feedback && !IsAboutFixed(k);
  if (result_ != nullptr || filters_.size() > 1) {
    epoch_.log_likelihood = modes_.Normalize(timeline_.node(k).t);
    const Gaussian combined = modes_.Combined(errors_);
    if (result_ != nullptr) RecordUpdate(k, combined);
    if (resets) Reset(k, combined);
  } else if (resets) {
    Reset(k, errors_.front());
  }
  for (std::size_t j = 0; j < filters_.size(); ++j) {
    Filter& f = filters_[j];
    const Gaussian& error = errors_[j];
    if (!error.mean.allFinite() || !f.x.p_e.allFinite() ||
        !error.P.allFinite()) {
      throw EstimationError(
          "filter diverged at t = " + std::to_string(f.epoch.t) + " s");
    }
    if (result_ != nullptr) epoch_.mean_plus.push_back(error.mean);
    f.epoch.x_plus = f.x;
    f.tape.Append(f.epoch, f.transition, f.P_minus, error.P);
  }
  if (result_ != nullptr) result_->tape.epochs.push_back(std::move(epoch_));
  epoch_ = {};
}

void ForwardPass::BeginEpochs(std::size_t k) {
  for (std::size_t j = 0; j < filters_.size(); ++j) {
    Filter& f = filters_[j];
    f.epoch = {};
    f.epoch.t = timeline_.node(k).t;
    f.epoch.x_minus = f.x;
    f.epoch.c = f.transition.c;
    f.epoch.dx_minus = errors_[j].mean;
    f.P_minus = errors_[j].P;
  }
}

/// Evaluates z at the nominal of f, its sigma multiplied by `factor`.
void ForwardPass::Linearize(std::size_t k, const Measurement& z,
                            const Filter& f, double factor) {
  Evaluate(z, timeline_.Context(k, z, f.model.layout, f.x), &linearized_);
  if (factor != 1.0) linearized_.R *= factor * factor;
}

/// What the models' mixture makes of measurement i of node k.
MeasurementVerdict ForwardPass::JudgeTogether(std::size_t k, int i) {
  const Measurement& z = timeline_.measurements(k)[static_cast<std::size_t>(i)];
  if (!rule_.AsksTheInnovation(z.sensor)) {
    return {.weight = 1.0, .accepted = rule_.MayUse(k, i)};
  }
  Linearize(k, z, filters_.front(), 1.0);
  double mean_square = 0.0;
  for (std::size_t j = 0; j < filters_.size(); ++j) {
    const double factor = FactorOf(filters_[j].model, z.sensor);
    mean_square +=
        modes_.probability()(static_cast<Eigen::Index>(j)) * factor * factor;
  }
  linearized_.R *= mean_square;
  const Gaussian combined = modes_.Combined(errors_);
  Innovation innovation;
  return rule_.Judge(k, i, combined.mean, combined.P, &linearized_,
                     &innovation);
}

/// Updates every model and its likelihood with measurement i of node k.
void ForwardPass::Use(std::size_t k, int i) {
  const Measurement& z = timeline_.measurements(k)[static_cast<std::size_t>(i)];
  TapeMeasurement header;
  header.index = i;
  header.sensor = z.sensor;
  header.withheld = z.withheld;
  const auto decide = [&header](const MeasurementVerdict& verdict) {
    header.accepted = verdict.accepted;
    header.weight = verdict.weight;
  };
  if (filters_.size() == 1) {
    const Filter& f = filters_.front();
    const Gaussian& error = errors_.front();
    Linearize(k, z, f, FactorOf(f.model, z.sensor));
    Innovation innovation;
    decide(rule_.Judge(k, i, error.mean, error.P, &linearized_, &innovation));
    Take(0, header, innovation);
    return;
  }
  modes_.Normalize(timeline_.node(k).t);
  decide(JudgeTogether(k, i));
  for (std::size_t j = 0; j < filters_.size(); ++j) {
    const Filter& f = filters_[j];
    Linearize(k, z, f, FactorOf(f.model, z.sensor));
    linearized_.R /= header.weight;
    Take(j, header, Innovate(linearized_, errors_[j].mean, errors_[j].P));
  }
}

/// Updates a model with the linearised measurement and records both on its
/// tape.
void ForwardPass::Take(std::size_t j, const TapeMeasurement& header,
                       const Innovation& innovation) {
  GainMatrix K;
  if (header.accepted) {
    modes_.Weigh(j, innovation.log_likelihood);
    K = Update(linearized_, innovation, &errors_[j].mean, &errors_[j].P);
  }
  filters_[j].tape.Record(header, linearized_, innovation, K);
}

void ForwardPass::RecordUpdate(std::size_t k, const Gaussian& combined) {
  epoch_.probability = modes_.probability();
  WriteCombined(filters_.front().model.layout, filters_.front().x, combined,
                modes_.probability(), k, &result_->trajectory);
}

/// Moves every nominal by the combined mean and the models' errors into the
/// tangent there.
void ForwardPass::Reset(std::size_t k, const Gaussian& combined) {
  const bool alone = filters_.size() == 1;
  const std::vector<ErrorVector> steps = modes_.Steps(errors_, combined);
  for (std::size_t j = 0; j < filters_.size(); ++j) {
    Filter& f = filters_[j];
    Gaussian& error = errors_[j];
    const ErrorLayout& layout = f.model.layout;
    f.x = Retract(error_, layout, f.x, steps[j]);
    f.x.t = f.epoch.t;
    f.epoch.reset = true;
    // The error of a single filter is zero at a node without measurements, but
    // for the first one after a fixed nominal: there is nothing to move.
    if (!alone || !timeline_.measurements(k).empty() ||
        !error.mean.isZero(0.0)) {
      const ErrorMatrix T =
          Transport(error_, layout, f.epoch.x_minus, steps[j], f.x);
      if (!alone) error.mean = (T * (error.mean - steps[j])).eval();
      MoveCovariance(T, &error.P);
    }
    if (alone) error.mean.setZero();
  }
}

}  // namespace hindsight
