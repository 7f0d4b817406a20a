#ifndef HINDSIGHT_ALIGNMENT_DAVENPORT_H_
#define HINDSIGHT_ALIGNMENT_DAVENPORT_H_

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace hindsight {

/// Davenport's q-method: the rotation C that minimises, for pairs of vectors,
///   L(C) = 1/2 sum |a_k - C b_k|^2 = const - q' K q,
///   K = [tr B, z'; z, B + B' - I tr B],   B = sum a_k b_k',
///   z = sum b_k x a_k, q = (w, x, y, z)
/// (Markley and Mortari 2000, Quaternion Attitude Estimation Using Vector
/// Observations, eqs. 8 and 9, for C turned the other way round). The four
/// eigenvectors of K are the best rotation and those turned from it by 180 deg
/// about three axes u_i, at which L is larger by lambda_1 - lambda_i; near the
/// best, L grows as (lambda_1 - lambda_i) angle^2 / 4.
struct VectorMatch {
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  /// Columns u_i in the axes of a, and lambda_1 - lambda_i, ascending.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Eigen::Vector3d gaps = Eigen::Vector3d::Zero();

  /// Covariance of psi, C = Exp(psi) C^, for errors of unit variance in every
  /// component of a: sum of 2 / gap_i u_i u_i', a component at most `largest`.
  Eigen::Matrix3d Covariance(double largest) const;
};

/// From the profile B = sum a_k b_k'.
VectorMatch MatchVectors(const Eigen::Matrix3d& B);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_DAVENPORT_H_
