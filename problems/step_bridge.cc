#include "problems/step_bridge.h"

#include <Eigen/LU>

namespace hindsight {
namespace {

/// Of one step at a time that is known both jump by the same: S is singular but for these,
/// by which its time is known to 3e-5 of the interval, and the position to 1e-6 m.
constexpr double kFloor = 1e-9;
constexpr double kPositionFloor = 1e-12;

Eigen::Matrix2d NoiseBetween(const Timeline& timeline, double from, double to) {
  const VelocityStep::Noise noise = timeline.VelocityNoise(from, to);
  return Eigen::Matrix2d({{noise.pp, noise.pv}, {noise.pv, noise.vv}});
}

}  // namespace

std::optional<StepBridge> BridgeOverSteps(const ErrorLayout& layout,
                                          const Timeline& timeline,
                                          std::size_t k, double t) {
  if (timeline.velocity_steps().empty()) return std::nullopt;
  const Block* position = layout.Find(BlockKind::kPosition);
  const Block* velocity = layout.Find(BlockKind::kVelocity);
  if (position == nullptr || position->dim != 3 || velocity == nullptr ||
      velocity->dim != 3) {
    return std::nullopt;
  }
  const double begin = timeline.node(k).t;
  const double end = timeline.node(k + 1).t;
  Eigen::Matrix2d S = NoiseBetween(timeline, begin, end);
  if (S(1, 1) == 0.0) return std::nullopt;
  S.diagonal() *= 1.0 + kFloor;
  S(0, 0) += kPositionFloor;
  const Eigen::Matrix2d S_t = NoiseBetween(timeline, begin, t);
  const Eigen::Matrix2d F({{1.0, end - t}, {0.0, 1.0}});
  const Eigen::Matrix2d gain = S_t * F.transpose() * S.inverse();
  return StepBridge{gain, S_t - gain * F * S_t, position->offset,
                    velocity->offset};
}

}  // namespace hindsight
