#ifndef HINDSIGHT_IMU_ERROR_DRIFT_H_
#define HINDSIGHT_IMU_ERROR_DRIFT_H_

#include "imu/preintegration.h"
#include "state/error_layout.h"

namespace hindsight {

/// [1/sqrt(s)]. A drift that bends more is one of several pieces: what bends
/// freely explains any correlated noise.
inline constexpr double kDriftWalk = 1e-3;

/// Whether the summary says how the block goes through its interval: coloured
/// noise e of the sensor (kColouredNoise) and, of a position sensor, the rate r
/// at which it drifts (kErrorRate, all axes of both estimated). Where the
/// step drifts and r is estimated,
///   e_j = phi e_i + r_i dt + w,   r_j = r_i + w_r, a walk of kDriftWalk times
///   the a priori sigma of r;
/// elsewhere r is drawn anew, so that it is free where a drift begins.
inline bool HasOwnStep(const Block& block, const ImuSummary& summary) {
  return (block.key.kind == BlockKind::kColouredNoise ||
          block.key.kind == BlockKind::kErrorRate) &&
         block.key.sensor == summary.coloured.sensor;
}

/// The block of r if `block` is e and drifts over the interval, else nullptr.
inline const Block* DriftRate(const ErrorLayout& layout, const Block& block,
                              const ImuSummary& summary) {
  if (block.key.kind != BlockKind::kColouredNoise ||
      !HasOwnStep(block, summary) || !summary.coloured.drifts) {
    return nullptr;
  }
  return layout.Find(BlockKind::kErrorRate, block.key.sensor);
}

/// phi and added variance of a block that HasOwnStep.
inline double OwnPhi(const Block& block, const ImuSummary& summary) {
  if (block.key.kind == BlockKind::kColouredNoise) return summary.coloured.phi;
  return summary.coloured.drifts ? 1.0 : 0.0;
}

inline double OwnVariance(const Block& block, const ImuSummary& summary) {
  if (block.key.kind == BlockKind::kColouredNoise) {
    return summary.coloured.variance;
  }
  const double variance = block.sigma0.x() * block.sigma0.x();
  return summary.coloured.drifts
             ? variance * kDriftWalk * kDriftWalk * summary.dt()
             : variance;
}

}  // namespace hindsight

#endif  // HINDSIGHT_IMU_ERROR_DRIFT_H_
