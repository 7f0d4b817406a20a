#ifndef HINDSIGHT_ALIGNMENT_COARSE_ALIGNMENT_H_
#define HINDSIGHT_ALIGNMENT_COARSE_ALIGNMENT_H_

#include "alignment/davenport.h"
#include "alignment/motion_vectors.h"

namespace hindsight {

/// Motion that tells the attitude of a vehicle coarsely [s].
inline constexpr double kAlignmentWindow = 40.0;

/// Attitude and biases at input.t from the motion of a window alone, no start
/// value needed.
struct CoarseAlignment {
  Eigen::Quaterniond q_eb = Eigen::Quaterniond::Identity();
  Eigen::Vector3d b_g = Eigen::Vector3d::Zero();  ///< [rad/s]
  Eigen::Vector3d b_a = Eigen::Vector3d::Zero();  ///< [m/s^2]
  /// Covariance of psi in NED axes [rad^2] with the biases' uncertainty, errors
  /// of the vectors taken as white and scaled up to the residuals found.
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
  /// By how much chi-square grows when the attitude is turned by 180 deg about
  /// the axis that the motion tells worst, and that axis in NED.
  double ambiguity = 0.0;
  Eigen::Vector3d ambiguous_axis = Eigen::Vector3d::UnitZ();
  std::size_t count = 0;  ///< of vectors
};

/// Optimisation-based alignment over [input.t, t_end]. The window is cut into
/// segments of 20 s; within each the free constants (V_0, and P_0 for
/// positions) are projected out of both sides of MotionVectors, so that all
/// vectors count and no error of an accelerometer grows for longer. In turns:
/// MatchVectors gives the attitude at the biases known so far; one Gauss-Newton
/// step on attitude and biases together, the biases with their a priori sigmas,
/// moves the biases. Empty with fewer than 4 vectors.
std::optional<CoarseAlignment> AlignCoarsely(const AlignmentInput& input,
                                             double t_end,
                                             const Eigen::Vector3d& b_g,
                                             const Eigen::Vector3d& b_a);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_COARSE_ALIGNMENT_H_
