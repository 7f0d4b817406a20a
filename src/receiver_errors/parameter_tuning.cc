#include "receiver_errors/parameter_tuning.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
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
  parameters_ = Bounded(tunables_, parameters_);
  value_ = Value(parameters_);
  for (std::size_t i = 0; i < 3; ++i) {
    if (!Walk(tunables_[i], kStep)) Walk(tunables_[i], 1.0 / kStep);
  }
  return ClimbFinely();
}

void ParameterTuning::ClimbAlone(double ErrorParameters::*member,
                                 const ErrorParameters& p) {
  constexpr double kStep = 1.3;
  parameters_ = Bounded(tunables_, p);
  value_ = Value(parameters_);
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
  return SumOfLogShares({&TunableOf(member)});
}

double ParameterTuning::Value(const ErrorParameters& p) const {
  return Values({p}).front();
}

std::vector<double> ParameterTuning::Values(
    const std::vector<ErrorParameters>& all) const {
  if (effort_ != nullptr) effort_->Spend(all.size() * tape_.size());
  std::vector<double> values(all.size());
  ForRanges(all.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      values[i] = ScoreSequence(tape_, all[i], sequence_).log_likelihood +
                  LogPriorOf(tunables_, all[i]);
    }
  });
  return values;
}

double ParameterTuning::LogShareOfPrior(const ErrorParameters& found,
                                        double least_scale) {
  tunables_.front().least = least_scale;
  parameters_ = found;
  value_ = Value(found);
  std::vector<const Tunable*> all;
  for (const Tunable& tunable : tunables_) all.push_back(&tunable);
  return SumOfLogShares(all);
}

ErrorParameters ParameterTuning::ClimbFinely() {
  constexpr double kFine = 1.08;
  const Tunable& scale = tunables_.front();
  if (!Walk(scale, kFine)) Walk(scale, 1.0 / kFine);
  return parameters_;
}

ErrorParameters ParameterTuning::Moved(const Tunable& tunable,
                                       double by) const {
  ErrorParameters p = parameters_;
  double& value = p.*tunable.member;
  value = std::clamp(value * std::exp(by), tunable.least, tunable.most);
  if (tunable.member != &ErrorParameters::sigma) return p;
  const auto down =
      std::ranges::find(tunables_, &ErrorParameters::down, &Tunable::member);
  if (down == tunables_.end()) return p;
  // What errors are down stays: else the two would hold each other where they are.
  p.down =
      std::clamp(p.down * parameters_.sigma / p.sigma, down->least, down->most);
  return p;
}

double ParameterTuning::SumOfLogShares(
    const std::vector<const Tunable*>& tunables) const {
  double sum = 0.0;
  const std::vector<Fall> falls = FallsOf(tunables);
  for (std::size_t i = 0; i < falls.size(); ++i) {
    sum += LogShareOfPrior(*tunables[i], falls[i]);
  }
  return sum;
}

std::vector<ParameterTuning::Fall> ParameterTuning::FallsOf(
    const std::vector<const Tunable*>& tunables) const {
  constexpr double kFalls = -0.5;
  constexpr double kWider = 3.0;
  std::vector<Fall> falls;
  std::vector<std::size_t> pending;
  for (const Tunable* tunable : tunables) {
    pending.push_back(falls.size());
    falls.push_back(
        {.at_least = parameters_.*tunable->member < 1.001 * tunable->least,
         .h = 0.15 * tunable->spread});
  }
  while (!pending.empty()) {
    std::vector<ErrorParameters> points;
    for (const std::size_t i : pending) {
      const auto& [at_least, h, near, far] = falls[i];
      points.push_back(Moved(*tunables[i], h));
      points.push_back(Moved(*tunables[i], at_least ? 2.0 * h : -h));
    }
    const std::vector<double> values = Values(points);
    std::vector<std::size_t> too_near;
    for (std::size_t n = 0; n < pending.size(); ++n) {
      const std::size_t i = pending[n];
      Fall& fall = falls[i];
      fall.near = values[2 * n] - value_;
      fall.far = values[2 * n + 1] - value_;
      if (std::max(fall.near, fall.far) > kFalls &&
          fall.h < tunables[i]->spread) {
        fall.h *= kWider;
        too_near.push_back(i);
      }
    }
    pending = std::move(too_near);
  }
  return falls;
}

double ParameterTuning::LogShareOfPrior(const Tunable& tunable,
                                        const Fall& fall) {
  const auto& [at_least, h, near, far] = fall;
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
    const ErrorParameters trial = Moved(tunable, std::log(step));
    if (trial.*tunable.member == parameters_.*tunable.member) return i > 0;
    const double value = Value(trial);
    if (!(value > value_)) return i > 0;
    parameters_ = trial;
    value_ = value;
  }
  return true;
}

}  // namespace hindsight
