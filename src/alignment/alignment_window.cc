#include "alignment/alignment_window.h"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "earth/wgs84.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

constexpr double kKnownHeading = 20.0 * kDegree;
constexpr double kClearlyWorse = 25.0;  // five sigmas
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
    return fmt::format(
        "too little acceleration, which tells it to {:.0f} deg alone",
        heading / kDegree);
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
  attitude.attitude = fmt::format(
      "specific force against {} measured motions up to t = {:.1f} s",
      alignment->coarse.count, alignment->t_end);
  if (alignment->refined && alignment->drifts) {
    attitude.attitude += fmt::format(
        ", while the gyros drifted by some {:.2g} deg/s a minute",
        alignment->refined->gyro_bias_walk * std::sqrt(60.0) / kDegree);
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

AlignmentWindow::AlignmentWindow(const AlignmentInput& input, double t_end)
    : input_(input),
      t_end_(t_end),
      coarse_(AlignCoarsely(input, t_end, input.b_g, input.b_a)),
      smoother_(input, t_end) {}

std::optional<VelocityAlignment> AlignmentWindow::Align(
    double least_walk, const VelocityAlignment* before) {
  if (!coarse_) return std::nullopt;
  VelocityAlignment out;
  out.coarse = *coarse_;
  out.t_end = t_end_;
  const bool goes_on =
      before != nullptr && before->refined && TellsHeading(before->attitude);
  out.refined = smoother_.Smooth(
      goes_on ? StartFrom(*before->refined) : StartFrom(*coarse_), least_walk);
  const Eigen::Matrix3d C_ne = NedAxes(input_.p_e).transpose();
  if (out.refined) {
    out.attitude = RefinedAttitude(*out.refined);
    if (!goes_on && !StaysNear(*coarse_, out.attitude, C_ne)) {
      out.refined.reset();
    }
  }
  if (!out.refined) {
    out.attitude = {};
    out.attitude.q_nb = Eigen::Quaterniond(C_ne) * coarse_->q_eb;
    out.attitude.P = coarse_->P;
  }
  out.drifts = out.refined && out.refined->gyro_bias_walk >
                                  input_.dataset.imu.noise.gyro_bias_walk;
  if (out.drifts) out.attitude.gyro_bias_walk = out.refined->gyro_bias_walk;
  out.attitude.reuse = kReuse;
  Describe(&out);
  return out;
}

}  // namespace hindsight
