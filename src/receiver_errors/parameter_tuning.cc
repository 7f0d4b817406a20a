#include "receiver_errors/parameter_tuning.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "receiver_errors/sequence_smoother.h"

namespace hindsight {
namespace {

/// ln of the integral of exp(slope u - curvature u^2 / 2) over u > 0.
double LogOfHalfIntegral(double slope, double curvature) {
  constexpr double kFar = 25.0;  // where erfc is not yet zero
  const double x = -slope / std::sqrt(2.0 * curvature);
  if (x > kFar) return -std::log(-slope);
  return 0.5 * std::log(0.5 * kPi / curvature) + x * x + std::log(std::erfc(x));
}

}  // namespace

ErrorParameters ParameterTuning::Climb() {
  value_ = Value(parameters_);
  for (const double step : {2.5, 1.3}) {
    for (const Tunable& tunable : tunables_) {
      if (!Walk(tunable, step)) Walk(tunable, 1.0 / step);
    }
  }
  return ClimbFinely();
}

ErrorParameters ParameterTuning::ClimbOfNoise(double least_scale) {
  constexpr double kStep = 1.3;
  tunables_.front().least = least_scale;
  value_ = Value(parameters_);
  for (std::size_t i = 0; i < 3; ++i) {
    if (!Walk(tunables_[i], kStep)) Walk(tunables_[i], 1.0 / kStep);
  }
  return ClimbFinely();
}

void ParameterTuning::ClimbAlone(double ErrorParameters::*member,
                                 const ErrorParameters& p) {
  constexpr double kStep = 1.3;
  parameters_ = p;
  value_ = Value(p);
  const Tunable& one = TunableOf(member);
  if (!Walk(one, kStep)) Walk(one, 1.0 / kStep);
}

const Tunable& ParameterTuning::TunableOf(
    double ErrorParameters::*member) const {
  return *std::ranges::find(tunables_, member, &Tunable::member);
}

double ParameterTuning::LogShareOfPrior(double ErrorParameters::*member,
                                        const ErrorParameters& found,
                                        double value) {
  parameters_ = found;
  value_ = value;
  return LogShareOfPrior(TunableOf(member));
}

double ParameterTuning::Value(const ErrorParameters& p) const {
  if (effort_ != nullptr) effort_->Spend(tape_.size());
  return ScoreSequence(tape_, p, sequence_).log_likelihood +
         LogPriorOf(tunables_, p);
}

double ParameterTuning::LogShareOfPrior(const ErrorParameters& found,
                                        double least_scale) {
  tunables_.front().least = least_scale;
  parameters_ = found;
  value_ = Value(found);
  double sum = 0.0;
  for (const Tunable& tunable : tunables_) sum += LogShareOfPrior(tunable);
  return sum;
}

ErrorParameters ParameterTuning::ClimbFinely() {
  constexpr double kFine = 1.08;
  const Tunable& scale = tunables_.front();
  if (!Walk(scale, kFine)) Walk(scale, 1.0 / kFine);
  return parameters_;
}

/// ln of what the posterior gains where the logarithm of a parameter is moved;
/// as at the bounds beyond them.
double ParameterTuning::GainAt(const Tunable& tunable, double by) const {
  ErrorParameters p = parameters_;
  p.*tunable.member =
      std::clamp(p.*tunable.member * std::exp(by), tunable.least, tunable.most);
  return Value(p) - value_;
}

double ParameterTuning::LogShareOfPrior(const Tunable& tunable) const {
  constexpr double kFalls = -0.5;
  constexpr double kWider = 3.0;
  const bool at_least = parameters_.*tunable.member < 1.001 * tunable.least;
  double h = 0.15 * tunable.spread;
  double near = 0.0;
  double far = 0.0;
  const auto fall = [&] {
    near = GainAt(tunable, h);
    far = GainAt(tunable, at_least ? 2.0 * h : -h);
    return std::max(near, far);
  };
  double falls = fall();
  while (falls > kFalls && h < tunable.spread) {
    h *= kWider;
    falls = fall();
  }
  const double prior = PriorCurvature(tunable);
  const double log_prior = LogOfIntegral(prior) + LogOfPriorWithin(tunable);
  if (!at_least) {
    const double curvature = std::max(prior, -(far + near) / (h * h));
    return LogOfIntegral(curvature) - log_prior;
  }
  const double curvature = std::max(prior, (2.0 * near - far) / (h * h));
  const double slope = near / h + 0.5 * curvature * h;
  return LogOfHalfIntegral(std::min(0.0, slope), curvature) - log_prior;
}

bool ParameterTuning::Walk(const Tunable& tunable, double step) {
  constexpr int kMost = 8;
  for (int i = 0; i < kMost; ++i) {
    if (IsSpent()) return i > 0;
    ErrorParameters trial = parameters_;
    trial.*tunable.member =
        std::clamp(trial.*tunable.member * step, tunable.least, tunable.most);
    if (trial.*tunable.member == parameters_.*tunable.member) return i > 0;
    const double value = Value(trial);
    if (!(value > value_)) return i > 0;
    parameters_ = trial;
    value_ = value;
  }
  return true;
}

}  // namespace hindsight
