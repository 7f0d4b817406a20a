#include "filters/heading_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/units.h"
#include "filters/iterated_smoother.h"
#include "filters/transport.h"

namespace hindsight {
namespace {

constexpr double kUnknown = 50.0 * kDegree;
constexpr double kStrongMotion = 100.0;  // energy over that of the noise
constexpr double kSpan = 1.0;            // [s]

/// Component of the heading error, or -1.
int HeadingOf(const ErrorLayout& layout) {
  const Block* attitude = layout.Find(BlockKind::kAttitude);
  const Block* velocity = layout.Find(BlockKind::kVelocity);
  const bool complete = attitude != nullptr && attitude->dim == 3 &&
                        velocity != nullptr && velocity->dim > 0;
  return complete ? attitude->offset + 2 : -1;
}

/// Energy of the changes of velocity by horizontal force, over that of white
/// noise.
double ForceOverNoise(const ErrorLayout& layout,
                      const std::vector<State>& states,
                      const Timeline& timeline) {
  double signal = 0.0;
  double noise = 0.0;
  Eigen::Vector2d dv = Eigen::Vector2d::Zero();
  double begin = states.front().t;
  for (std::size_t k = 0; k + 1 < states.size(); ++k) {
    const ImuSummary& summary = timeline.Summary(k);
    const CorrectedMean mean =
        Correct(summary, CalibrationOf(layout, states[k]));
    const Eigen::Matrix<double, 2, 3> horizontal =
        (states[k].C_en().transpose() * states[k].q_eb.toRotationMatrix())
            .topRows<2>();
    dv += horizontal * mean.dv;
    noise +=
        (horizontal * summary.noise.block<3, 3>(3, 3) * horizontal.transpose())
            .trace();
    if (states[k + 1].t - begin < kSpan && k + 2 < states.size()) continue;
    signal += dv.squaredNorm();
    dv.setZero();
    begin = states[k + 1].t;
  }
  return signal / noise;
}

/// A prior that knows the heading, and what it says of that.
struct KnownHeading {
  Prior prior;
  double log_density = 0.0;
};

KnownHeading KnowHeading(const ErrorLayout& layout, const Prior& prior,
                         const State& heading, double sigma) {
  const int h = HeadingOf(layout);
  const double innovation = Local(layout, prior.x, heading)(h);
  const double S = prior.P(h, h) + sigma * sigma;
  const ErrorVector K = prior.P.col(h) / S;
  KnownHeading known;
  known.log_density = -0.5 * (innovation * innovation / S + std::log(S));
  known.prior.x = Retract(layout, prior.x, ErrorVector(K * innovation));
  known.prior.P = prior.P - K * prior.P.row(h);
  MoveCovariance(Transport(layout, prior.x, known.prior.x), &known.prior.P);
  return known;
}

std::vector<State> Turned(const ErrorLayout& layout, double angle,
                          std::vector<State> states) {
  ErrorVector d = ErrorVector::Zero(layout.dim());
  d(HeadingOf(layout)) = angle;
  for (State& x : states) x = Retract(layout, x, d);
  return states;
}

}  // namespace

bool HeadingMayBeNoise(const ErrorLayout& layout,
                       const std::vector<State>& states,
                       const CovarianceSeries& P, const Timeline& timeline) {
  const int h = HeadingOf(layout);
  if (h < 0 || states.size() < 2 || P.empty()) return false;
  return std::sqrt(P.Get(0)(h, h)) < kUnknown &&
         ForceOverNoise(layout, states, timeline) < kStrongMotion;
}

namespace {

/// The log-likelihood over the heading at the first state, up to a constant.
class Profile {
 public:
  Profile(const ErrorLayout& layout, const Prior& prior,
          const std::vector<State>& states, const CovarianceSeries& P,
          Timeline* timeline, const GateDecisions& decisions)
      : layout_(layout),
        prior_(prior),
        states_(states),
        timeline_(timeline),
        decisions_(decisions),
        sigma_(std::sqrt(P.Get(0)(HeadingOf(layout), HeadingOf(layout)))) {}

  double sigma() const { return sigma_; }

  /// With the heading `angle` from that of the states. Throws EstimationError.
  double At(double angle) const {
    constexpr double kTight = 0.02;  // of sigma
    IterationOptions options;
    options.max_iterations = 4;
    std::vector<State> nominal = Turned(layout_, angle, states_);
    const KnownHeading known =
        KnowHeading(layout_, prior_, nominal.front(), kTight * sigma_);
    return known.log_density + SmoothIterated(layout_, known.prior,
                                              std::move(nominal), timeline_,
                                              decisions_, options)
                                   .log_likelihood;
  }

 private:
  const ErrorLayout& layout_;
  const Prior& prior_;
  const std::vector<State>& states_;
  Timeline* timeline_;
  const GateDecisions& decisions_;
  double sigma_;
};

}  // namespace

HeadingCredit CreditHeading(const ErrorLayout& layout, const Prior& prior,
                            const std::vector<State>& states,
                            const CovarianceSeries& P, Timeline* timeline,
                            const GateDecisions& decisions) {
  HeadingCredit credit;
  if (!HeadingMayBeNoise(layout, states, P, *timeline)) return credit;
  const int h = HeadingOf(layout);
  credit.open = std::min(credit.open, prior.P(h, h));
  const Profile profile(layout, prior, states, P, timeline, decisions);
  const double step = std::min(2.0 * profile.sigma(), 0.5 * kPi);
  try {
    const double turned = 0.5 * (profile.At(-step) + profile.At(step));
    const double information = 2.0 * (profile.At(0.0) - turned) / (step * step);
    const double claimed = 1.0 / (profile.sigma() * profile.sigma());
    const double given = std::min(1.0 / prior.P(h, h), claimed);
    constexpr double kRare = 1e-4;
    const double by_chance =
        given + std::sqrt(-2.0 * std::log(kRare) * (claimed - given));
    credit.curvature = information > by_chance ? information / claimed : 0.0;
  } catch (const EstimationError&) {
    credit.curvature = 0.0;
  }
  return credit;
}

bool MayBeTurnedRound(const ErrorLayout& layout,
                      const std::vector<State>& states,
                      const Timeline& timeline) {
  constexpr double kTelling = 1e4;  // energy over that of the noise
  const bool sides_alone =
      std::any_of(timeline.sensors().begin(), timeline.sensors().end(),
                  [](const Sensor& sensor) {
                    return sensor.type == SensorType::kNonHolonomic;
                  });
  return sides_alone && HeadingOf(layout) >= 0 && states.size() > 1 &&
         ForceOverNoise(layout, states, timeline) < kTelling;
}

double LogOddsOfTurnedRound(const ErrorLayout& layout, Prior prior,
                            const std::vector<State>& states,
                            const CovarianceSeries& P, Timeline* timeline,
                            const GateDecisions& decisions) {
  constexpr double kRefuted = -std::numeric_limits<double>::infinity();
  if (!MayBeTurnedRound(layout, states, *timeline)) return kRefuted;
  const int h = HeadingOf(layout);
  prior.P.row(h).setZero();
  prior.P.col(h).setZero();
  constexpr double kAnything = 100.0;  // [rad]
  prior.P(h, h) = kAnything * kAnything;
  const Profile profile(layout, prior, states, P, timeline, decisions);
  try {
    return std::min(0.0, profile.At(kPi) - profile.At(0.0));
  } catch (const EstimationError&) {
    return kRefuted;
  }
}

void WidenHeading(const ErrorLayout& layout, const HeadingCredit& credit,
                  CovarianceSeries* P) {
  if (!(credit.curvature < kCredibleHeading)) return;
  const int h = HeadingOf(layout);
  for (std::size_t k = 0; k < P->size(); ++k) {
    ErrorMatrix P_k = P->Get(k);
    const double variance = P_k(h, h);
    const double wider =
        std::min(variance / (credit.curvature * credit.curvature), credit.open);
    if (!(wider > variance)) continue;
    const ErrorVector c = P_k.col(h) / variance;
    P_k += (wider - variance) * c * c.transpose();
    P->Set(k, P_k);
  }
}

}  // namespace hindsight
