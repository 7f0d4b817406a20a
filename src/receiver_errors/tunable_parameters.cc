#include "receiver_errors/tunable_parameters.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace hindsight {

std::vector<Tunable> TunablesOf(const ModeSequence& sequence,
                                const ErrorParameters& from) {
  std::vector<Tunable> out = {
      {&ErrorParameters::scale, kLeastScale, 100.0, 1.0, 0.7,
       "the factor on the stated sigma", "1"},
      {&ErrorParameters::outlier_share, 1e-3, 0.4, 0.02, 1.5,
       "the share of outliers", "1"},
      {&ErrorParameters::outlier_ratio, 3.0, 1000.0, 10.0, 1.5},
      {&ErrorParameters::imu_scale, kLeastImuScale, 100.0, 1.0, 1.1,
       "the factor on the noise of the IMU", "1"}};
  bool good = false;
  bool biased = false;
  bool slight = false;
  bool drifting = false;
  std::size_t parts = 0;
  for (const ErrorStep& step : sequence) {
    good |= step.mode == ErrorMode::kGood;
    biased |= step.mode == ErrorMode::kBiased;
    slight |= step.mode == ErrorMode::kSlight;
    drifting |= step.mode == ErrorMode::kDrifting || step.velocity_step;
    parts += step.anew ? 1 : 0;
  }
  // What is slow is the IMU's or the receiver's: where it errs throughout in several
  // parts nothing but the stated noise tells. Of one error FollowBias asks both.
  // Several biases have one sigma for all axes.
  const bool is_one = biased && !slight && !drifting && parts <= 1;
  if (!good && !is_one) out.back().least = 1.0;
  if (biased) {
    out.push_back({&ErrorParameters::tau, 0.1, 1e9, from.tau, 2.3});
    out.push_back({&ErrorParameters::sigma, 1e-4, 1e5, from.sigma, 2.3,
                   "the sigma of the bias", "m"});
    if (is_one) out.push_back({&ErrorParameters::down, 0.02, 50.0, 1.0, 1.1});
  }
  if (slight) {
    out.push_back(
        {&ErrorParameters::slight_tau, 0.1, 1e9, from.slight_tau, 2.3});
    out.push_back({&ErrorParameters::slight_sigma, 1e-4, 1e5, from.slight_sigma,
                   kSpreadOfSlight});
  }
  if (drifting) {
    out.push_back(
        {&ErrorParameters::rate_sigma, 1e-6, 1e3, from.rate_sigma, 2.3});
  }
  return out;
}

ErrorParameters Bounded(const std::vector<Tunable>& tunables,
                        ErrorParameters p) {
  for (const Tunable& tunable : tunables) {
    double& value = p.*tunable.member;
    value = std::clamp(value, tunable.least, tunable.most);
  }
  return p;
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

double PriorCurvature(const Tunable& tunable) {
  return 1.0 / (tunable.spread * tunable.spread);
}

double LogOfPriorWithin(const Tunable& tunable) {
  const double below = std::log(tunable.least / tunable.typical);
  return std::log(0.5 *
                  std::erfc(below * std::sqrt(0.5 * PriorCurvature(tunable))));
}

double LogOfIntegral(double curvature) {
  return 0.5 * std::log(2.0 * kPi / curvature);
}

}  // namespace hindsight
