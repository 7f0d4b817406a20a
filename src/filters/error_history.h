#ifndef HINDSIGHT_FILTERS_ERROR_HISTORY_H_
#define HINDSIGHT_FILTERS_ERROR_HISTORY_H_

#include <vector>

#include "filters/linear_tape.h"
#include "filters/mixing.h"

namespace hindsight {

/// What a position receiver's error is at a fix, beyond white noise.
enum class ErrorMode : char {
  kGood,     ///< none
  kBiased,   ///< e, a Gauss-Markov process
  kDrifting  ///< e grows at a rate r that hardly changes
};

/// How the error came to a fix from the one before it. `anew`: of a bias, e is
/// drawn anew (a jump); of a drift, r is. A bias that is not new goes on, or
/// follows a drift that stops. `jolt`: what goes on does so over an interval in
/// which the IMU has jolted: its velocity has a jump that no noise explains,
/// which else would pass for a drift of the receiver.
struct ErrorStep {
  ErrorMode mode = ErrorMode::kGood;
  bool anew = false;
  bool jolt = false;
  bool operator==(const ErrorStep&) const = default;
};

/// A step for each node that has a fix of the receiver, in order.
using ErrorHistory = std::vector<ErrorStep>;

struct ErrorParameters {
  double scale = 1.0;           ///< on the stated sigma of a fix
  double outlier_share = 0.02;  ///< of the fixes
  double outlier_ratio = 10.0;  ///< sigma of an outlier, by that of others
  double sigma = 10.0;          ///< of a bias, an axis [m]
  double tau = 1000.0;          ///< its correlation time [s]
  double rate_sigma = 0.1;      ///< of a drift, and of a jolt, an axis [m/s]
};

/// Over an interval, an axis:
///   e' = ee e + er r + w_e,   r' = rr r + w_r,
///   cov(w_e, w_r) = (q_ee, q_er; q_er, q_rr),
/// and a jump of the velocity of variance q_vv where it begins.
struct ErrorDynamics {
  double ee = 0.0, er = 0.0, rr = 0.0;
  double q_ee = 0.0, q_er = 0.0, q_rr = 0.0;
  double q_vv = 0.0;
};
ErrorDynamics DynamicsOf(const ErrorParameters& parameters, ErrorStep step,
                         double dt);

/// ln probability of a step after a mode, where `fixes` fixes are expected to
/// hold a few changes.
double LogTransition(ErrorMode before, ErrorStep step, int fixes);
/// The steps that may follow a mode.
std::vector<ErrorStep> StepsAfter(ErrorMode before);

/// The steps into every node: those of the history at fixes, between them what
/// goes on.
std::vector<ErrorStep> StepsByNode(const LinearTape& tape, int receiver,
                                   const ErrorHistory& history);
/// Whether the node has a fix of the receiver that is used.
bool HasFix(const LinearTape& tape, std::size_t k, int receiver);

/// The linear system of a tape about one fixed nominal, extended by the error
/// (e, r) of one position receiver, north, east, down each; its fixes see e.
class ErrorChain {
 public:
  ErrorChain(const LinearTape& tape, int receiver,
             const ErrorParameters& parameters);

  std::size_t size() const { return tape_.size(); }
  int fix_count() const { return fix_count_; }
  int dim() const { return navigation_dim_ + 6; }

  Gaussian Begin() const;

  /// Makes node k and the interval before it the present ones.
  void MoveTo(std::size_t k);
  double t() const { return tape_.epoch(k_).t; }
  bool has_fix() const { return fix_ >= 0; }
  /// Measurements of the node over (navigation, e, r).
  const std::vector<LinearizedMeasurement>& measurements() const { return z_; }

  /// The navigation part goes over the interval; e and r do not yet.
  Gaussian PredictNavigation(const Gaussian& x) const;
  /// Completes a prediction.
  void PredictError(ErrorStep step, Gaussian* x) const;
  /// The transition of the whole system.
  ErrorMatrix Phi(ErrorStep step) const;

  /// ln of the likelihood of the fix, which may be an outlier, and whether it
  /// rather is one.
  struct FixLikelihood {
    double log = 0.0;
    bool outlier = false;
  };
  /// After PredictError.
  FixLikelihood LikelihoodOfFix(const Gaussian& x) const;
  /// What the fix sees of a state after PredictNavigation, whatever the step of
  /// the error.
  struct FixView {
    Eigen::Vector3d innovation;  ///< residual - H_n mean_n
    Eigen::Matrix3d S;           ///< H_n P_n H_n'
    Eigen::Matrix3d P_ze, P_zr;  ///< H_n P_ne, H_n P_nr
    Eigen::Vector3d e, r;
    Eigen::Matrix3d P_ee, P_er, P_rr;
  };
  FixView ViewOf(const Gaussian& x) const;
  /// As if PredictError of `step` came next.
  FixLikelihood LikelihoodAfter(ErrorStep step, const FixView& view) const;

  /// Updates with all measurements of the node; returns ln of the likelihood of
  /// those beside the fix. `used` gets what was used, if asked for.
  struct Used {
    LinearizedMeasurement z;
    Innovation innovation;
    RowJacobian HP;  ///< with P before the update
  };
  double UpdateAll(bool outlier, Gaussian* x,
                   std::vector<Used>* used = nullptr) const;

 private:
  FixLikelihood Likelihood(const ErrorDynamics& d, const FixView& view) const;

  const LinearTape& tape_;
  int receiver_;
  ErrorParameters parameters_;
  int navigation_dim_;
  int position_ = -1;  ///< offsets, or -1 if an axis is masked
  int velocity_ = -1;
  int fix_count_ = 0;
  std::size_t k_ = 0;
  ErrorMatrix Phi_n_;
  ErrorMatrix Q_n_;
  double dt_ = 0.0;
  int fix_ = -1;  ///< index in z_
  std::vector<LinearizedMeasurement> z_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_ERROR_HISTORY_H_
