#include "dataset/turned_rest.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dataset/bias_sigma.h"
#include "imu/mean_reading.h"

namespace hindsight {
namespace {

/// In which gyros that warm up drift by an a priori sigma of their bias [s].
constexpr double kWarmUp = 60.0;

struct RateOfSpan {
  TimeInterval span;
  Eigen::Vector3d w;
  /// Of the a priori bias, in squared sigmas.
  double misfit = 0.0;
};

class Comparison {
 public:
  explicit Comparison(const Dataset& dataset)
      : dataset_(dataset), bias_sigma_(GyroBiasSigma(dataset.initial)) {}

  RateOfSpan Of(const TimeInterval& span) const {
    RateOfSpan rate;
    rate.span = span;
    rate.w = Mean(span);
    const double sigma = Sigma(span.length());
    rate.misfit = ((rate.w - dataset_.initial.gyro_bias).array().square() /
                   (bias_sigma_.array().square() + sigma * sigma))
                      .sum();
    return rate;
  }

  /// By their means, and by what they read where they face each other, so that
  /// a drift within or between them is none of a turn's making, nor is a motion
  /// that begins or ends at one of them.
  bool Contradict(const RateOfSpan& a, const RateOfSpan& b) const {
    return MeansDiffer(a, b) && EdgesDiffer(a, b);
  }

  bool Drifts(const TimeInterval& span) const {
    const double middle = 0.5 * (span.begin + span.end);
    return MeansDiffer(Of({span.begin, middle}), Of({middle, span.end}));
  }

 private:
  static constexpr double kSigmas = 5.0;

  bool MeansDiffer(const RateOfSpan& a, const RateOfSpan& b) const {
    const double apart =
        std::abs(a.span.begin + a.span.end - b.span.begin - b.span.end) / 2.0;
    const double walk =
        dataset_.imu.noise.gyro_bias_walk * std::sqrt(std::max(0.0, apart));
    const double sigma =
        std::hypot(Sigma(a.span.length()), Sigma(b.span.length()), walk);
    return (a.w - b.w).cwiseAbs().maxCoeff() > kSigmas * sigma;
  }

  bool EdgesDiffer(const RateOfSpan& a, const RateOfSpan& b) const {
    if (b.span.begin < a.span.begin) return EdgesDiffer(b, a);
    constexpr double kEdge = 2.0;  // [s]
    const TimeInterval last = {std::max(a.span.begin, a.span.end - kEdge),
                               a.span.end};
    const TimeInterval first = {b.span.begin,
                                std::min(b.span.end, b.span.begin + kEdge)};
    const double apart =
        0.5 * (first.begin + first.end - last.begin - last.end);
    const double sigma =
        std::hypot(Sigma(last.length()), Sigma(first.length()));
    const Eigen::Array3d walk = (bias_sigma_ / std::sqrt(kWarmUp))
                                    .array()
                                    .max(dataset_.imu.noise.gyro_bias_walk);
    return ((Mean(last) - Mean(first)).array().square() >
            kSigmas * kSigmas * (sigma * sigma + walk.square() * apart))
        .any();
  }

  Eigen::Vector3d Mean(const TimeInterval& span) const {
    return MeanReading(dataset_.imu, span.begin, span.end).w_ib_b;
  }
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
  std::vector<RateOfSpan> rates;
  for (const TimeInterval& span : rest->at_rest) {
    rates.push_back(comparison.Of(span));
  }
  std::sort(rates.begin(), rates.end(),
            [](const RateOfSpan& a, const RateOfSpan& b) {
              return a.misfit < b.misfit;
            });
  double rival = kDecided;
  std::vector<RateOfSpan> kept;
  for (const RateOfSpan& rate : rates) {
    if (std::any_of(kept.begin(), kept.end(), [&](const RateOfSpan& of) {
          return comparison.Contradict(rate, of);
        })) {
      rival = std::min(rival, rate.misfit - rates.front().misfit);
    } else {
      kept.push_back(rate);
    }
  }
  if (kept.size() == rates.size() ||
      std::any_of(
          rest->at_rest.begin(), rest->at_rest.end(),
          [&](const TimeInterval& span) { return comparison.Drifts(span); })) {
    return;
  }
  if (rival < kDecided) kept.clear();
  std::vector<TimeInterval> agreeing;
  for (const TimeInterval& span : rest->at_rest) {
    const bool stays = std::any_of(
        kept.begin(), kept.end(),
        [&](const RateOfSpan& of) { return of.span.begin == span.begin; });
    (stays ? agreeing : rest->turning).push_back(span);
  }
  rest->at_rest = std::move(agreeing);
}

}  // namespace hindsight
