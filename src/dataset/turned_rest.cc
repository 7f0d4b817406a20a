#include "dataset/turned_rest.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "dataset/bias_sigma.h"
#include "imu/mean_reading.h"

namespace hindsight {
namespace {

struct MeanRate {
  TimeInterval span;
  Eigen::Vector3d w;
  /// Of the a priori bias, in squared sigmas.
  double misfit = 0.0;
};

class Comparison {
 public:
  explicit Comparison(const Dataset& dataset)
      : dataset_(dataset), bias_sigma_(GyroBiasSigma(dataset.initial)) {}

  MeanRate Of(const TimeInterval& span) const {
    MeanRate rate;
    rate.span = span;
    rate.w = MeanReading(dataset_.imu, span.begin, span.end).w_ib_b;
    const double sigma = Sigma(span.length());
    rate.misfit = ((rate.w - dataset_.initial.gyro_bias).array().square() /
                   (bias_sigma_.array().square() + sigma * sigma))
                      .sum();
    return rate;
  }

  bool Contradict(const MeanRate& a, const MeanRate& b) const {
    constexpr double kSigmas = 5.0;
    const double apart =
        std::abs(a.span.begin + a.span.end - b.span.begin - b.span.end) / 2.0;
    const double walk =
        dataset_.imu.noise.gyro_bias_walk * std::sqrt(std::max(0.0, apart));
    const double sigma =
        std::hypot(Sigma(a.span.length()), Sigma(b.span.length()), walk);
    return (a.w - b.w).cwiseAbs().maxCoeff() > kSigmas * sigma;
  }

  bool Drifts(const TimeInterval& span) const {
    const double middle = 0.5 * (span.begin + span.end);
    return Contradict(Of({span.begin, middle}), Of({middle, span.end}));
  }

 private:
  double Sigma(double seconds) const {
    return std::hypot(
        dataset_.stationary.rate_sigma,
        dataset_.imu.noise.gyro_noise_density / std::sqrt(seconds));
  }

  const Dataset& dataset_;
  Eigen::Vector3d bias_sigma_;
};

}  // namespace

void LeaveOutTurned(const Dataset& dataset, Rest* rest) {
  constexpr double kDecided = 10.0;  // 2 ln(150)
  const Comparison comparison(dataset);
  std::vector<MeanRate> rates;
  for (const TimeInterval& span : rest->at_rest) {
    rates.push_back(comparison.Of(span));
  }
  const auto nearest = std::min_element(
      rates.begin(), rates.end(),
      [](const MeanRate& a, const MeanRate& b) { return a.misfit < b.misfit; });
  double rival = kDecided;
  std::vector<TimeInterval> agreeing;
  for (const MeanRate& rate : rates) {
    if (comparison.Contradict(rate, *nearest)) {
      rival = std::min(rival, rate.misfit - nearest->misfit);
    } else {
      agreeing.push_back(rate.span);
    }
  }
  if (agreeing.size() == rates.size() ||
      std::any_of(
          rest->at_rest.begin(), rest->at_rest.end(),
          [&](const TimeInterval& span) { return comparison.Drifts(span); })) {
    return;
  }
  if (rival < kDecided) agreeing.clear();
  std::copy_if(
      rest->at_rest.begin(), rest->at_rest.end(),
      std::back_inserter(rest->turning), [&](const TimeInterval& span) {
        return std::none_of(
            agreeing.begin(), agreeing.end(),
            [&](const TimeInterval& kept) { return kept.begin == span.begin; });
      });
  rest->at_rest = std::move(agreeing);
}

}  // namespace hindsight
