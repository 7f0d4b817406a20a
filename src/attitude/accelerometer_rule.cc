#include "attitude/accelerometer_rule.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/error.h"

namespace hindsight {
namespace {

constexpr double kPassedOver = std::numeric_limits<double>::infinity();

}  // namespace

double FixedRule::Variance(double /*s*/) { return sigma * sigma; }

double GateRule::Variance(double s) {
  return s <= limit ? sigma * sigma : kPassedOver;
}

double HeldGateRule::Variance(double s) {
  if (s > limit) {
    closed_for = hold;
    return kPassedOver;
  }
  if (closed_for > 0) {
    --closed_for;
    return kPassedOver;
  }
  return sigma * sigma;
}

double AdaptiveRule::Variance(double s) {
  return sigma * sigma + lambda * s * s;
}

SmncRule::SmncRule(double sigma, double lambda, std::vector<double> beta)
    : sigma2_(sigma * sigma),
      lambda_(lambda),
      beta_(std::move(beta)),
      equal_(std::all_of(beta_.begin(), beta_.end(),
                         [this](double b) { return b == beta_.front(); })),
      s2_(beta_.size(), 0.0) {
  if (beta_.empty()) throw std::invalid_argument("SMNC without weights");
}

SmncRule::SmncRule(double sigma, double lambda, int N)
    : SmncRule(sigma, lambda,
               std::vector<double>(static_cast<std::size_t>(N + 1), 1.0)) {}

double SmncRule::Variance(double s) {
  const double s2 = s * s;
  const std::size_t count = s2_.size();
  if (equal_) sum_ += s2 - s2_[next_];
  s2_[next_] = s2;
  double weighted = beta_.front() * sum_;
  if (!equal_) {
    weighted = 0.0;
    for (std::size_t j = 0; j < count; ++j) {
      weighted += beta_[j] * s2_[(next_ + count - j) % count];
    }
  }
  next_ = next_ + 1 == count ? 0 : next_ + 1;
  // Differences of squares leave rounding, never a variance below R0.
  return sigma2_ + lambda_ * std::max(weighted, 0.0);
}

int SamplesIn(double seconds, double sample_interval) {
  return static_cast<int>(std::lround(seconds / sample_interval));
}

AccelerometerRule MakeAccelerometerRule(
    const AccelerometerRuleOptions& options) {
  if (options.name == "fixed") return FixedRule{options.sigma};
  if (options.name == "gate") return GateRule{options.sigma, options.limit};
  if (options.name == "held_gate") {
    return HeldGateRule{options.sigma, options.limit, options.N};
  }
  if (options.name == "adaptive") {
    return AdaptiveRule{options.sigma, options.lambda * (options.N + 1)};
  }
  if (options.name == "smnc") {
    return SmncRule(options.sigma, options.lambda, options.N);
  }
  throw InputError("unknown accelerometer rule '" + options.name +
                   "'; known are fixed, gate, held_gate, adaptive, smnc");
}

}  // namespace hindsight
