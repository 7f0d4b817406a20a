#ifndef HINDSIGHT_FILTERS_ERROR_CHAIN_H_
#define HINDSIGHT_FILTERS_ERROR_CHAIN_H_

#include <vector>

#include "filters/error_history.h"
#include "filters/linear_tape.h"
#include "filters/mixing.h"

namespace hindsight {

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
  /// Its process noise: the two predictions together are
  ///   x <- Phi x + (c, 0, 0) + w,   w ~ (0, Q),
  /// with the tape's defect c. Singular: what a step leaves or draws of e and r
  /// may have no noise.
  ErrorMatrix Q(ErrorStep step) const;
  /// (c, 0, 0) of the interval; of no meaning before the first node, as Phi, Q.
  ErrorVector Defect() const;

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

  /// Measurement i of the node as UpdateAll uses it, the fix with the noise of
  /// an outlier if it is taken for one.
  LinearizedMeasurement MeasurementAs(std::size_t i, bool outlier) const;
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

#endif  // HINDSIGHT_FILTERS_ERROR_CHAIN_H_
