#include "filters/heading_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/units.h"
#include "filters/iterated_smoother.h"
#include "filters/transport.h"
#include "measurements/sensor_kind.h"

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
double ForceOverNoise(const Problem& problem,
                      const std::vector<State>& states) {
  double signal = 0.0;
  double noise = 0.0;
  Eigen::Vector2d dv = Eigen::Vector2d::Zero();
  double begin = states.front().t;
  for (std::size_t k = 0; k + 1 < states.size(); ++k) {
    const ImuSummary& summary = problem.timeline.Summary(k);
    const CorrectedMean mean =
        Correct(summary, CalibrationOf(problem.layout, states[k]));
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

/// A prior updated by a measured heading, and ln of that heading's density by
/// the prior, up to a constant.
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

bool HeadingMayBeNoise(const Problem& problem, const std::vector<State>& states,
                       const CovarianceSeries& P) {
  const int h = HeadingOf(problem.layout);
  if (h < 0 || states.size() < 2 || P.empty()) return false;
  return std::sqrt(P.Get(0)(h, h)) < kUnknown &&
         ForceOverNoise(problem, states) < kStrongMotion;
}

namespace {

/// The log-likelihood over the heading at the first state, up to a constant.
class Profile {
 public:
  Profile(Problem problem, const std::vector<State>& states,
          const CovarianceSeries& P)
      : problem_(std::move(problem)),
        prior_(problem_.prior),
        states_(states),
        sigma_(std::sqrt(P.Get(0)(HeadingOf(problem_.layout),
                                  HeadingOf(problem_.layout)))) {}

  double sigma() const { return sigma_; }

  /// Log-likelihood with the first heading held at that of the states plus
  /// `angle`. Throws EstimationError.
  double At(double angle) {
    constexpr double kTight = 0.02;  // to which the heading is held, in sigma_
    std::vector<State> nominal = Turned(problem_.layout, angle, states_);
    KnownHeading known =
        KnowHeading(problem_.layout, prior_, nominal.front(), kTight * sigma_);
    problem_.prior = std::move(known.prior);
    return known.log_density +
           SettledLogLikelihood(std::move(nominal), &problem_);
  }

 private:
  Problem problem_;
  Prior prior_;
  const std::vector<State>& states_;
  double sigma_;
};

}  // namespace

HeadingCredit CreditHeading(const Problem& problem,
                            const std::vector<State>& states,
                            const CovarianceSeries& P) {
  HeadingCredit credit;
  if (!HeadingMayBeNoise(problem, states, P)) return credit;
  const int h = HeadingOf(problem.layout);
  const double given_variance = problem.prior.P(h, h);
  credit.open = std::min(credit.open, given_variance);
  Profile profile(problem, states, P);
  const double step = std::min(2.0 * profile.sigma(), 0.5 * kPi);
  try {
    const double turned = 0.5 * (profile.At(-step) + profile.At(step));
    const double information = 2.0 * (profile.At(0.0) - turned) / (step * step);
    const double claimed = 1.0 / (profile.sigma() * profile.sigma());
    const double given = std::min(1.0 / given_variance, claimed);
    constexpr double kRare = 1e-4;
    const double by_chance =
        given + std::sqrt(-2.0 * std::log(kRare) * (claimed - given));
    credit.curvature = information > by_chance ? information / claimed : 0.0;
  } catch (const EstimationError&) {
    credit.curvature = 0.0;
  }
  return credit;
}

bool MayBeTurnedRound(const Problem& problem,
                      const std::vector<State>& states) {
  constexpr double kTelling = 1e4;  // energy over that of the noise
  const bool sides_alone = std::any_of(
      problem.timeline.sensors().begin(), problem.timeline.sensors().end(),
      [](const Sensor& sensor) { return sensor.kind->generated; });
  return sides_alone && HeadingOf(problem.layout) >= 0 && states.size() > 1 &&
         ForceOverNoise(problem, states) < kTelling;
}

double LogOddsOfTurnedRound(Problem problem, const std::vector<State>& states,
                            const CovarianceSeries& P) {
  constexpr double kRefuted = -std::numeric_limits<double>::infinity();
  if (!MayBeTurnedRound(problem, states)) return kRefuted;
  const int h = HeadingOf(problem.layout);
  Prior& prior = problem.prior;
  prior.P.row(h).setZero();
  prior.P.col(h).setZero();
  constexpr double kAnything = 100.0;  // sigma of a free heading [rad]
  prior.P(h, h) = kAnything * kAnything;
  Profile profile(std::move(problem), states, P);
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
