#ifndef HINDSIGHT_FILTERS_COVARIANCE_POLICY_H_
#define HINDSIGHT_FILTERS_COVARIANCE_POLICY_H_

#include <limits>
#include <vector>

#include "base/error.h"
#include "imu/imu_link.h"

namespace hindsight {

/// Which Riccati equation the forward filter's P follows; its gain is always
/// K = P C' R^-1, eqs. (3), (4) of Yu, Lee, Park and Shim, "Design of a SDINS
/// using the nonlinear observer".
enum class RiccatiRule {
  kKalman,             ///< P' = A P + P A' + Q - P C' R^-1 C P
  kHInfinity,          ///< ... - P (C' R^-1 C - gamma^-2 L' L) P
  kModifiedHInfinity,  ///< P' = (A + alpha I) P + P (A + alpha I)' + Q
                       ///<      - P (C' R^-1 C - delta L' L) P
};

/// Of that paper only the first page was at hand, which names the modified
/// equation but does not print it. kModifiedHInfinity therefore has both
/// features that the first page can mean: a prescribed degree of stability
/// alpha (Reif, Sonnemann and Unbehauen 1999), and a weight delta that is
/// chosen freely in place of gamma^-2.
struct CovarianceOptions {
  /// A block of the error that is part of z = L x, divided by `unit` (SI).
  struct Bounded {
    BlockKind kind = BlockKind::kAttitude;
    double unit = 1.0;
  };

  RiccatiRule rule = RiccatiRule::kKalman;
  /// Of kHInfinity: bound of the gain from disturbances to the error of z
  /// [sqrt(s)], as z is in units.
  double gamma = std::numeric_limits<double>::infinity();
  std::vector<Bounded> L = {{}};  ///< attitude in rad
  /// Of kModifiedHInfinity.
  double alpha = 0.0;         ///< [1/s], on velocity and attitude
  bool alpha_on_all = false;  ///< on every block instead
  double delta = 0.0;         ///< [1/s]; negative: more cautious than Kalman
  /// Sets gamma to infinity (delta to zero) for the steps at which the weight
  /// would double an eigenvalue of L P L': those that lead to a P that becomes
  /// infinite within finite time (FiniteEscape).
  bool back_off = false;
};

/// How the weight of L' L fared over a pass.
struct BoundRecord {
  int back_offs = 0;  ///< steps at which gamma was backed off
  /// Smallest eigenvalue of I - theta L P L' over the other steps: the share of
  /// the information on L x that the weight left. At 0 P becomes infinite.
  double least_information = 1.0;
};

/// P has no solution any more: an eigenvalue reached infinity.
class FiniteEscape : public EstimationError {
 public:
  FiniteEscape(double t, double weight);
  double t() const { return t_; }  ///< when [s]

 private:
  double t_;
};

/// The discrete form of a rule, over the steps of one pass:
///   P-     = Phi_a P Phi_a' + Q,              Phi_a = exp(alpha S dt) Phi,
///   P+^-1  = P-^-1 + H' R^-1 H - theta L' L,  theta = gamma^-2 dt or delta dt,
///   dx     = P+ H' R^-1 residual,
/// S selecting the blocks of alpha: Anderson and Moore 1979, sec. 6.2, for
/// alpha on all blocks; Simon 2006, eqs. (11.89) - (11.91), for theta, which is
/// applied at every step, measured or not. Exact in dt but for the order in
/// which alpha and Phi act, alpha dt^2 |S A - A S|.
class CovariancePolicy {
 public:
  /// Throws std::logic_error if L names a block that the layout has not.
  CovariancePolicy(const CovarianceOptions& options, const ErrorLayout& layout);

  /// Whether P is the error's covariance under the model, so that smoothers may
  /// read it.
  bool is_kalman() const { return weight_ == 0.0 && alpha_.size() == 0; }

  /// P <- Phi_a P Phi_a' + Q.
  void Predict(const Transition& transition, double dt, ErrorMatrix* P) const;

  /// Takes theta L' L from the information of P after the measurements at t, at
  /// the end of a step of dt, and moves dx, their correction, to the gain that
  /// belongs to it:
  ///   P <- (P^-1 - theta L' L)^-1 = P + P L' theta (I - theta L P L')^-1 L P,
  ///   dx <- P P_before^-1 dx.
  /// P^-1 - theta L' L is positive definite exactly if P and I - theta L P L'
  /// are; both are factorised at every step. Throws FiniteEscape otherwise,
  /// with the time at which P^-1, falling linearly over the step, is singular.
  void Bound(double t, double dt, ErrorVector* dx, ErrorMatrix* P);

  /// gamma^-2 L' L or delta L' L [1/s].
  ErrorMatrix WeightMatrix() const;
  /// Per component [1/s]; empty without alpha.
  const ErrorVector& alpha() const { return alpha_; }
  const BoundRecord& record() const { return record_; }

 private:
  using LMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0,
                                kMaxErrorDim, kMaxErrorDim>;

  double weight_ = 0.0;
  bool may_back_off_ = false;
  BoundRecord record_;
  LMatrix L_;
  ErrorVector alpha_;  ///< per component; empty: none
};

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_COVARIANCE_POLICY_H_
