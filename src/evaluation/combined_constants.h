#ifndef HINDSIGHT_EVALUATION_COMBINED_CONSTANTS_H_
#define HINDSIGHT_EVALUATION_COMBINED_CONSTANTS_H_

#include <map>
#include <span>
#include <string>
#include <vector>

#include "dataset/recorded_constants.h"
#include "evaluation/constant_agreement.h"
#include "state/solution.h"

namespace hindsight {

/// What several recordings say of the same constants, for the next one.
struct CombinedConstants {
  std::vector<ConstantEstimate> constants;
  Eigen::MatrixXd P;  ///< of their errors in the next recording
  /// Mounting of every sensor that has one, C_sb as a whole.
  std::map<std::string, Eigen::Quaterniond> q_sb;
  std::vector<ConstantAgreement> agreement;  ///< in the order of constants
  /// All of them together: what is left of their distances from the mean, with
  /// their correlations.
  double chi_square = 0.0;
  double dof = 0.0;
  double probability = 1.0;
  std::vector<Evidence> evidence;
};

/// Weighted mean of the constants that any of the recordings has. Each tells
/// what its data add to what it started from,
///   I_r = P_r^-1 - P_r0^-1,   eta_r = P_r^-1 x_r - P_r0^-1 x_r0
/// (along what data that widen sigmas have made less known, nothing), and the
/// start of the first that has the constant counts once:
///   P = (P_0^-1 + sum I_r)^-1,   x = P (P_0^-1 x_0 + sum eta_r).
/// Constants that differ by more than chance (kDisagreementByChance, shared
/// over the constants) vary from recording to recording by tau, of DerSimonian
/// and Laird (1986): with T = diag(tau^2),
///   I_r' = (1 + I_r T)^-1 I_r,   eta_r' = (1 + I_r T)^-1 eta_r,
/// and the next recording's have the covariance P + T. Where all of them
/// together differ still, P is widened by chi^2 / dof (Birge 1932). Both are
/// doubtful, and `evidence` says so. Requires at least two recordings. Throws
/// InputError where units differ, where the constants of one started from a
/// result, which would count again, or nothing is shared.
CombinedConstants CombineConstants(std::span<const RecordedConstants> all);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_COMBINED_CONSTANTS_H_
