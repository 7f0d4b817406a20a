#include "receiver_errors/error_tuning.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "base/units.h"
#include "receiver_errors/regime_choice.h"
#include "receiver_errors/sequence_smoother.h"

namespace hindsight {
namespace {

/// A parameter that the likelihood decides, with its prior: normal in the
/// logarithm.
struct Tunable {
  double ErrorParameters::*member;
  double least;
  double most;
  double typical;
  double spread;  ///< standard deviation of the logarithm
  /// Of the quantity, where its bounds mean something.
  const char* name = nullptr;
  const char* unit = "";
};

std::vector<Tunable> TunablesOf(const ModeSequence& sequence,
                                const ErrorParameters& from) {
  std::vector<Tunable> out = {
      {&ErrorParameters::scale, kLeastScale, 100.0, 1.0, 0.7,
       "the factor on the stated sigma", "1"},
      {&ErrorParameters::outlier_share, 1e-3, 0.4, 0.02, 1.5,
       "the share of outliers", "1"},
      {&ErrorParameters::outlier_ratio, 3.0, 1000.0, 10.0, 1.5},
      {&ErrorParameters::imu_scale, 1.0, 100.0, 1.0, 1.1,
       "the factor on the noise of the IMU", "1"}};
  bool biased = false;
  bool slight = false;
  bool drifting = false;
  for (const ErrorStep& step : sequence) {
    biased |= step.mode == ErrorMode::kBiased;
    slight |= step.mode == ErrorMode::kSlight;
    drifting |= step.mode == ErrorMode::kDrifting || step.velocity_step;
  }
  if (biased) {
    out.push_back({&ErrorParameters::tau, 0.1, 1e9, from.tau, 2.3});
    out.push_back({&ErrorParameters::sigma, 1e-4, 1e5, from.sigma, 2.3,
                   "the sigma of the bias", "m"});
  }
  if (slight) {
    out.push_back(
        {&ErrorParameters::slight_tau, 0.1, 1e9, from.slight_tau, 2.3});
    out.push_back(
        {&ErrorParameters::slight_sigma, 1e-4, 1e5, from.slight_sigma, 1.0});
  }
  if (drifting) {
    out.push_back(
        {&ErrorParameters::rate_sigma, 1e-6, 1e3, from.rate_sigma, 2.3});
  }
  return out;
}

double LogPriorOf(const std::vector<Tunable>& tunables,
                  const ErrorParameters& p) {
  double log_prior = 0.0;
  for (const Tunable& tunable : tunables) {
    const double z =
        std::log(p.*tunable.member / tunable.typical) / tunable.spread;
    log_prior -= 0.5 * z * z;
  }
  return log_prior;
}

/// ln of the integral of exp(slope u - curvature u^2 / 2) over u > 0.
double LogOfHalfIntegral(double slope, double curvature) {
  constexpr double kFar = 25.0;  // where erfc is not yet zero
  const double x = -slope / std::sqrt(2.0 * curvature);
  if (x > kFar) return -std::log(-slope);
  return 0.5 * std::log(0.5 * kPi / curvature) + x * x + std::log(std::erfc(x));
}

/// ln of the integral of exp(-curvature u^2 / 2) over all u.
double LogOfIntegral(double curvature) {
  return 0.5 * std::log(2.0 * kPi / curvature);
}

double PriorCurvature(const Tunable& tunable) {
  return 1.0 / (tunable.spread * tunable.spread);
}

/// ln of the share of a parameter's prior that is within its bounds; they are wide
/// above.
double LogOfPriorWithin(const Tunable& tunable) {
  const double below = std::log(tunable.least / tunable.typical);
  return std::log(0.5 *
                  std::erfc(below * std::sqrt(0.5 * PriorCurvature(tunable))));
}

/// The likelihood of a sequence as a function of the parameters.
class Tuning {
 public:
  Tuning(const LinearTape& tape, int receiver, const ModeSequence& sequence,
         const ErrorParameters& from, SearchEffort* effort)
      : tape_(tape),
        receiver_(receiver),
        sequence_(sequence),
        tunables_(TunablesOf(sequence, from)),
        parameters_(from),
        effort_(effort) {}

  /// Multiplies each parameter by smaller and smaller steps while it gains.
  ErrorParameters Climb() {
    value_ = Value(parameters_);
    for (const double step : {2.5, 1.3}) {
      for (const Tunable& tunable : tunables_) {
        if (!Walk(tunable, step)) Walk(tunable, 1.0 / step);
      }
    }
    return ClimbFinely();
  }

  BiasRange FollowBias(const ErrorParameters& found) {
    std::vector<RidgePoint> ridge = FollowBias(found, kRidgeStep);
    std::ranges::reverse(ridge);
    ridge.push_back(RidgePointAt(found));
    std::ranges::move(FollowBias(found, 1.0 / kRidgeStep),
                      std::back_inserter(ridge));
    const RidgePoint& best =
        *std::ranges::max_element(ridge, {}, &RidgePoint::value);
    double sum = 0.0;
    double sum_squares = 0.0;
    for (const RidgePoint& one : ridge) {
      const double weight = std::exp(one.value - best.value);
      sum += weight;
      sum_squares += weight * one.sigma * one.sigma;
    }
    BiasRange range{.likeliest = WithBias(found, best),
                    .mean_square = WithBias(
                        found, OfSigma(ridge, std::sqrt(sum_squares / sum)))};
    const Tunable& tau = TunableOf(&ErrorParameters::tau);
    parameters_ = range.likeliest;
    value_ = best.value;
    range.log_gain = std::max(0.0, std::log(sum * std::log(kRidgeStep)) -
                                       LogOfIntegral(PriorCurvature(tau)) -
                                       LogShareOfPrior(tau));
    return range;
  }

  double LogShareOfPrior(const ErrorParameters& found, double least_scale) {
    tunables_.front().least = least_scale;
    parameters_ = found;
    value_ = Value(found);
    double sum = 0.0;
    for (const Tunable& tunable : tunables_) sum += LogShareOfPrior(tunable);
    return sum;
  }

  /// The first three, scale and outliers, alone.
  ErrorParameters ClimbOfNoise(double least_scale) {
    constexpr double kStep = 1.3;
    tunables_.front().least = least_scale;
    value_ = Value(parameters_);
    for (std::size_t i = 0; i < 3; ++i) {
      if (!Walk(tunables_[i], kStep)) Walk(tunables_[i], 1.0 / kStep);
    }
    return ClimbFinely();
  }

 private:
  ErrorParameters ClimbFinely() {
    constexpr double kFine = 1.08;
    const Tunable& scale = tunables_.front();
    if (!Walk(scale, kFine)) Walk(scale, 1.0 / kFine);
    return parameters_;
  }

  static constexpr double kRidgeStep = 2.0;  ///< of tau

  /// Of a bias, with the likeliest sigma of a tau.
  struct RidgePoint {
    double tau = 0.0;
    double sigma = 0.0;
    double value = 0.0;  ///< ln of the posterior
  };

  static ErrorParameters WithBias(ErrorParameters p, const RidgePoint& at) {
    p.tau = at.tau;
    p.sigma = at.sigma;
    return p;
  }

  const Tunable& TunableOf(double ErrorParameters::*member) const {
    return *std::ranges::find(tunables_, member, &Tunable::member);
  }

  RidgePoint RidgePointAt(const ErrorParameters& p) {
    constexpr double kStep = 1.3;
    parameters_ = p;
    value_ = Value(p);
    const Tunable& sigma = TunableOf(&ErrorParameters::sigma);
    if (!Walk(sigma, kStep)) Walk(sigma, 1.0 / kStep);
    return {
        .tau = parameters_.tau, .sigma = parameters_.sigma, .value = value_};
  }

  /// The points with a tau `step` times that of the one before, `found` the first.
  std::vector<RidgePoint> FollowBias(const ErrorParameters& found,
                                     double step) {
    constexpr int kMost = 12;
    std::vector<RidgePoint> ridge;
    double best = Value(found);
    ErrorParameters p = found;
    for (int i = 0; i < kMost; ++i) {
      if (effort_ != nullptr && effort_->IsSpent()) break;
      p.tau *= step;
      p.sigma *= std::sqrt(step);
      const RidgePoint point = RidgePointAt(p);
      if (point.value < best - kLeastGain) break;
      best = std::max(best, point.value);
      ridge.push_back(point);
      p = WithBias(p, point);
    }
    return ridge;
  }

  /// Between the points of a ridge of growing sigma and tau; at its ends beyond them.
  static RidgePoint OfSigma(const std::vector<RidgePoint>& falling,
                            double sigma) {
    for (std::size_t i = 1; i < falling.size(); ++i) {
      const RidgePoint& above = falling[i - 1];
      const RidgePoint& below = falling[i];
      if (below.sigma > sigma || above.sigma <= below.sigma) continue;
      const double part =
          std::log(sigma / below.sigma) / std::log(above.sigma / below.sigma);
      return {.tau = below.tau * std::pow(above.tau / below.tau, part),
              .sigma = sigma};
    }
    return {.tau = falling.back().tau, .sigma = sigma};
  }

  double Value(const ErrorParameters& p) const {
    if (effort_ != nullptr) effort_->Spend(tape_.size());
    return ScoreSequence(tape_, receiver_, p, sequence_).log_likelihood +
           LogPriorOf(tunables_, p);
  }

  /// ln of what the posterior gains where the logarithm of a parameter is moved;
  /// as at the bounds beyond them.
  double GainAt(const Tunable& tunable, double by) const {
    ErrorParameters p = parameters_;
    p.*tunable.member = std::clamp(p.*tunable.member * std::exp(by),
                                   tunable.least, tunable.most);
    return Value(p) - value_;
  }

  /// ln of the integral over the logarithm of one parameter of the posterior, by
  /// its value here, less that of the prior: from a parabola through three points
  /// so far apart that it falls, at least as narrow as the prior, with its top here.
  double LogShareOfPrior(const Tunable& tunable) const {
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

  bool Walk(const Tunable& tunable, double step) {
    constexpr int kMost = 8;
    for (int i = 0; i < kMost; ++i) {
      if (effort_ != nullptr && effort_->IsSpent()) return i > 0;
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

  const LinearTape& tape_;
  int receiver_;
  const ModeSequence& sequence_;
  std::vector<Tunable> tunables_;
  ErrorParameters parameters_;
  SearchEffort* effort_;
  double value_ = 0.0;
};

}  // namespace

ErrorParameters TuneParameters(const LinearTape& tape, int receiver,
                               const ModeSequence& sequence,
                               const ErrorParameters& from,
                               SearchEffort* effort) {
  return Tuning(tape, receiver, sequence, from, effort).Climb();
}

BiasRange FollowBias(const LinearTape& tape, int receiver,
                     const ModeSequence& sequence, const ErrorParameters& found,
                     const ErrorParameters& from, SearchEffort* effort) {
  return Tuning(tape, receiver, sequence, from, effort).FollowBias(found);
}

ErrorParameters TuneNoise(const LinearTape& tape, int receiver,
                          const ModeSequence& sequence,
                          const ErrorParameters& from, double least_scale,
                          SearchEffort* effort) {
  return Tuning(tape, receiver, sequence, from, effort)
      .ClimbOfNoise(least_scale);
}

double LogPriorOf(const ModeSequence& sequence, const ErrorParameters& p,
                  const ErrorParameters& typical) {
  return LogPriorOf(TunablesOf(sequence, typical), p);
}

double LogShareOfPrior(const LinearTape& tape, int receiver,
                       const ModeSequence& sequence,
                       const ErrorParameters& found,
                       const ErrorParameters& typical, double least_scale,
                       SearchEffort* effort) {
  return Tuning(tape, receiver, sequence, typical, effort)
      .LogShareOfPrior(found, least_scale);
}

double MostOfLogShare(const ModeSequence& sequence,
                      const ErrorParameters& typical, double least_scale) {
  std::vector<Tunable> tunables = TunablesOf(sequence, typical);
  tunables.front().least = least_scale;
  double sum = 0.0;
  for (const Tunable& tunable : tunables) sum -= LogOfPriorWithin(tunable);
  return sum;
}

std::vector<BoundedValue> BoundedParameters(const ModeSequence& sequence,
                                            const ErrorParameters& found,
                                            bool is_tolerance) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::vector<BoundedValue> values;
  for (const Tunable& t : TunablesOf(sequence, found)) {
    if (t.name == nullptr) continue;
    const bool any_below =
        t.member == &ErrorParameters::outlier_share ||
        t.member == &ErrorParameters::imu_scale ||
        (is_tolerance && t.member == &ErrorParameters::scale);
    values.push_back({.name = t.name,
                      .unit = t.unit,
                      .value = found.*t.member,
                      .least = any_below ? -kNone : t.least,
                      .most = t.most});
  }
  return values;
}

}  // namespace hindsight
