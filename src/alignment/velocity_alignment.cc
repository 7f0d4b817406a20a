#include "alignment/velocity_alignment.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "alignment/levelling.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

constexpr double kKnownHeading = 20.0 * kDegree;
constexpr double kWellKnown = 0.5 * kDegree;
constexpr double kClearlyWorse = 25.0;  // five sigmas
constexpr double kFirstWindow = 10.0;   // [s]
constexpr double kLongestWindow = 320.0;
/// The same measurements serve again in what starts from here.
constexpr double kReuse = 10.0;

/// An attitude as good as its covariance, but of unknown heading.
void ForgetHeading(AlignedAttitude* attitude) {
  const double tilt = std::min(
      kUnknownHeadingSigma,
      std::sqrt(attitude->P.topLeftCorner<2, 2>().diagonal().maxCoeff()));
  attitude->P = Eigen::Vector3d(tilt, tilt, kUnknownHeadingSigma)
                    .cwiseAbs2()
                    .asDiagonal();
}

std::string AxisName(const Eigen::Vector3d& axis) {
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  constexpr const char* kNames[] = {"north", "east", "the vertical"};
  return kNames[largest];
}

/// Why the heading is not to be relied on; empty if it is.
std::string WhyUnknown(const VelocityAlignment& alignment) {
  const double heading = std::sqrt(alignment.attitude.P(2, 2));
  const bool turns = alignment.coarse.ambiguity < kClearlyWorse;
  if (heading > kKnownHeading && turns) {
    return "too little acceleration, every heading fits nearly as well";
  }
  if (heading > kKnownHeading) {
    char words[96];
    std::snprintf(words, sizeof(words),
                  "too little acceleration, which tells it to %.0f deg alone",
                  heading / kDegree);
    return words;
  }
  if (turns) {
    return "turned by 180 deg about " +
           AxisName(alignment.coarse.ambiguous_axis) +
           " the motion fits nearly as well";
  }
  return alignment.refined ? "" : "the refinement did not settle";
}

WindowStart StartFrom(const CoarseAlignment& coarse) {
  return {coarse.q_eb, coarse.b_g, coarse.b_a, coarse.P};
}

WindowStart StartFrom(const WindowSolution& refined) {
  const State& x = refined.states.front();
  const int a = refined.layout.Find(BlockKind::kAttitude)->offset;
  return {x.q_eb, x.b_g, x.b_a, refined.P.Get(0).block<3, 3>(a, a)};
}

void Describe(VelocityAlignment* alignment) {
  AlignedAttitude& attitude = alignment->attitude;
  char words[96];
  std::snprintf(words, sizeof(words),
                "specific force against %zu measured motions up to t = %.1f s",
                alignment->coarse.count, alignment->t_end);
  attitude.attitude = words;
  if (alignment->refined && alignment->drifts) {
    std::snprintf(
        words, sizeof(words),
        ", while the gyros drifted by some %.2g deg/s a minute",
        alignment->refined->gyro_bias_walk * std::sqrt(60.0) / kDegree);
    attitude.attitude += words;
  }
  const std::string why = WhyUnknown(*alignment);
  attitude.heading = why.empty() ? "the same" : "unknown: " + why;
  if (!why.empty()) ForgetHeading(&attitude);
}

/// Whether the refinement stayed where the coarse alignment, which knows no
/// other minimum, had led it: within ten degrees or five sigmas.
bool StaysNear(const CoarseAlignment& coarse, const AlignedAttitude& refined,
               const Eigen::Matrix3d& C_ne) {
  constexpr double kNear = 10.0 * kDegree;
  constexpr double kFiveSigmas = 25.0;
  const Eigen::Vector3d d =
      Log(refined.q_nb * (Eigen::Quaterniond(C_ne) * coarse.q_eb).conjugate());
  const Eigen::Matrix3d P = coarse.P + refined.P;
  return d.norm() < kNear || d.dot(P.llt().solve(d)) < kFiveSigmas;
}

/// Mean direction of travel, by speed; absent if the vehicle hardly moves.
std::optional<Eigen::Vector3d> DirectionOfTravel(
    const WindowSolution& solution) {
  constexpr double kMoving = 3.0;  // [m/s]
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const State& x : solution.states) {
    if (x.v_e.norm() > kMoving) sum += x.q_eb.conjugate() * x.v_e;
  }
  if (sum.norm() == 0.0) return std::nullopt;
  return sum.normalized();
}

AlignedAttitude RefinedAttitude(const WindowSolution& refined) {
  AlignedAttitude out;
  const State& first = refined.states.front();
  out.q_nb = Eigen::Quaterniond(first.C_en().transpose()) * first.q_eb;
  const int a = refined.layout.Find(BlockKind::kAttitude)->offset;
  out.P = refined.P.Get(0).block<3, 3>(a, a);
  out.travel_b = DirectionOfTravel(refined);
  return out;
}

}  // namespace

double FirstMotion(const AlignmentInput& input) {
  double t = input.to;
  const bool has_velocity =
      std::any_of(input.dataset.streams.begin(), input.dataset.streams.end(),
                  [](const AidingStream& stream) {
                    return !stream.measurements.empty() &&
                           std::holds_alternative<VelocityFix>(
                               stream.measurements.front().model);
                  });
  for (const TimedVelocity& v : input.velocities) {
    if (has_velocity && v.t >= input.t) t = std::min(t, v.t);
  }
  for (const TimedFix& fix : input.fixes) {
    if (!has_velocity && fix.t >= input.t) t = std::min(t, fix.t);
  }
  return t;
}

std::optional<VelocityAlignment> AlignOverWindow(
    const AlignmentInput& input, double t_end,
    const VelocityAlignment* before) {
  const auto coarse = AlignCoarsely(input, t_end, input.b_g, input.b_a);
  if (!coarse) return std::nullopt;
  VelocityAlignment out;
  out.coarse = *coarse;
  out.t_end = t_end;
  const bool goes_on =
      before != nullptr && before->refined && TellsHeading(before->attitude);
  out.refined = SmoothWindow(
      input, t_end, goes_on ? StartFrom(*before->refined) : StartFrom(*coarse));
  const Eigen::Matrix3d C_ne = NedAxes(input.p_e).transpose();
  if (out.refined) {
    out.attitude = RefinedAttitude(*out.refined);
    if (!goes_on && !StaysNear(*coarse, out.attitude, C_ne)) {
      out.refined.reset();
    }
  }
  if (!out.refined) {
    out.attitude = {};
    out.attitude.q_nb = Eigen::Quaterniond(C_ne) * coarse->q_eb;
    out.attitude.P = coarse->P;
  }
  out.drifts = out.refined && out.refined->gyro_bias_walk >
                                  input.dataset.imu.noise.gyro_bias_walk;
  if (out.drifts) out.attitude.gyro_bias_walk = out.refined->gyro_bias_walk;
  out.attitude.reuse = kReuse;
  Describe(&out);
  return out;
}

namespace {

/// The same from the end of the rest at input.t on: while it does not turn, its
/// attitude is that at input.t, and the gyro bias is what the gyros read.
AlignmentInput AfterRest(const AlignmentInput& input) {
  constexpr double kMargin = 1.0;  // [s]
  AlignmentInput out = input;
  if (!input.rest || input.rest->length() < 2.0 * kMargin) return out;
  out.t = input.rest->end - kMargin;
  const TimeInterval rest{input.t, out.t};
  out.b_g_before = GyroBiasAfterRest(input.dataset, rest);
  out.b_g = out.b_g_before->b_g;
  if (DriftAtRest(input.dataset.imu, rest) > 0.0) {
    out.least_gyro_walk = WarmUpWalk(input);
  }
  return out;
}

struct WindowSearch {
  std::optional<VelocityAlignment> best;
  /// Gyro bias walk that the last window shows beyond the stated one; else 0.
  double walk = 0.0;
  /// A window shows it by itself; else two that contradict each other do, and
  /// what else may be wrong with either.
  bool drifts = false;
};

/// Ends at the first sign of a drift that input.least_gyro_walk does not know.
WindowSearch SearchWindows(const AlignmentInput& input) {
  const double first = FirstMotion(input);
  WindowSearch search;
  std::optional<VelocityAlignment>& best = search.best;
  bool done = false;
  for (double window = kFirstWindow; window <= kLongestWindow; window *= 2.0) {
    const double t_end = std::min(first + window, input.to);
    auto found = AlignOverWindow(input, t_end, best ? &*best : nullptr);
    const bool contradicts = found && best && best->refined && found->refined &&
                             Contradict(found->attitude, best->attitude);
    if (found && found->drifts) {
      search.walk = found->refined->gyro_bias_walk;
      search.drifts = true;
    }
    if (contradicts) search.walk = std::max(search.walk, WarmUpWalk(input));
    const bool explained = input.least_gyro_walk > 0.0 || search.walk == 0.0;
    if (contradicts || !explained) break;
    if (found && (!best || (found->refined && found->attitude.P.trace() <
                                                  best->attitude.P.trace()))) {
      best = std::move(found);
    }
    if (done || t_end >= input.to) break;
    done = best &&
           best->attitude.P.diagonal().maxCoeff() < kWellKnown * kWellKnown;
  }
  return search;
}

}  // namespace

AlignmentOutcome AlignByVelocity(const AlignmentInput& input) {
  AlignmentInput from = AfterRest(input);
  WindowSearch search = SearchWindows(from);
  const bool drifts = from.least_gyro_walk > 0.0 || search.drifts;
  if (from.least_gyro_walk == 0.0 && search.walk > 0.0) {
    from.least_gyro_walk = search.walk;
    search = SearchWindows(from);
  }
  if (!search.best) return {std::nullopt, "too few velocities or positions"};
  AlignedAttitude attitude = search.best->attitude;
  if (!drifts) attitude.gyro_bias_walk = 0.0;
  return {attitude, ""};
}

}  // namespace hindsight
