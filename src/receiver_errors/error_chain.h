#ifndef HINDSIGHT_RECEIVER_ERRORS_ERROR_CHAIN_H_
#define HINDSIGHT_RECEIVER_ERRORS_ERROR_CHAIN_H_

#include <vector>

#include "filters/mixing.h"
#include "receiver_errors/error_dynamics.h"
#include "receiver_errors/sensor_tape.h"

namespace hindsight {

/// The linear system of a tape about one fixed nominal, extended by the error
/// (e, r) of one sensor, three axes each, of which a fix sees as many of e as it
/// has rows: north, east, down of a position or velocity, one of a height or a
/// heading. Of a magnetometer whose hard iron is estimated e is such a field, in
/// vehicle axes, of which an azimuth sees what turns it.
///
/// A Gaussian x of the chain is over its first components: e where the receiver is not
/// good and r where it drifts follow the navigation errors. What x has not is zero.
class ErrorChain {
 public:
  /// The tape must outlive this.
  ErrorChain(const SensorTape& tape, const ErrorParameters& parameters);
  ErrorChain(SensorTape&& tape, const ErrorParameters& parameters) = delete;

  std::size_t size() const { return tape_.size(); }
  /// Of (navigation, e, r).
  int dim() const { return navigation_dim_ + 6; }
  /// Of what such a mode leaves of an x.
  int DimOf(ErrorMode mode) const;
  /// The first `dim` components of x, with zeros in the place of those that it has not.
  static Gaussian Resized(const Gaussian& x, int dim);

  /// Before any measurement, of a receiver that is good.
  Gaussian Begin() const;

  /// Makes node k and the interval before it the present ones.
  void MoveTo(std::size_t k);
  double t() const { return tape_.t(k_); }
  bool has_fix() const { return fix_ >= 0; }
  /// SensorTape::share of the node.
  double share() const { return tape_.share(k_); }
  /// Measurements of the node over (navigation, e, r).
  const std::vector<LinearizedMeasurement>& measurements() const { return z_; }

  /// Predicts the navigation errors over the interval and leaves e and r as
  /// they are before it.
  void PredictNavigation(Gaussian* x) const;
  /// Predicts e and r over the interval as `step` says; PredictNavigation came
  /// before.
  void PredictError(ErrorStep step, Gaussian* x) const;
  /// The transition of the whole system.
  ErrorMatrix Phi(ErrorStep step) const;
  /// Its process noise: the two predictions together are
  ///   x <- Phi x + (c, 0, 0) + w,   w ~ (0, Q),
  /// with the tape's defect c. Q is singular where a step adds no noise to e or
  /// to r.
  ErrorMatrix Q(ErrorStep step) const;
  /// The same of a step of e and r in no time, with everything else at rest.
  ErrorMatrix PhiAtOnce(ErrorStep step) const;
  ErrorMatrix QAtOnce(ErrorStep step) const;
  /// (c, 0, 0) of the interval. Like Phi and Q it means nothing at the first
  /// node, which has no interval before it.
  ErrorVector Defect() const;

  /// ln of the likelihood of the fix, which may be an outlier, and whether it
  /// rather is one.
  struct FixLikelihood {
    double log = 0.0;
    bool outlier = false;
    double log_odds = 0.0;  ///< of being none; infinite if there are none
  };
  /// Odds below which later fixes may yet tell that one was an outlier [ln].
  static constexpr double kSureLogOdds = 8.0;
  /// The likelihood of the node's fix, x being what PredictError of `step` gave:
  /// with step.outlier that of an outlier with its share.
  FixLikelihood LikelihoodOfFix(ErrorStep step, const Gaussian& x) const;
  /// What the fix sees of a state after PredictNavigation, whatever the step of
  /// the error.
  struct FixView {
    // Rows that the fix has not are zero, with a noise of 1 / (2 pi), so that
    // they add nothing to any density.
    Eigen::Vector3d innovation =
        Eigen::Vector3d::Zero();                     ///< residual - H_n mean_n
    Eigen::Matrix3d S = Eigen::Matrix3d::Zero();     ///< H_n P_n H_n'
    Eigen::Matrix3d P_ze = Eigen::Matrix3d::Zero();  ///< H_n P_ne
    Eigen::Matrix3d P_zr = Eigen::Matrix3d::Zero();  ///< H_n P_nr
    Eigen::Vector3d e = Eigen::Vector3d::Zero();
    Eigen::Vector3d r = Eigen::Vector3d::Zero();
    Eigen::Matrix3d P_ee = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d P_er = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d P_rr = Eigen::Matrix3d::Zero();
  };
  FixView ViewOf(const Gaussian& x) const;
  /// What LikelihoodOfFix would give after PredictError of `step`.
  FixLikelihood LikelihoodAfter(ErrorStep step, const FixView& view) const;

  /// Measurement i of the node as UpdateAll uses it, the fix with the noise of
  /// an outlier if it is taken for one.
  LinearizedMeasurement MeasurementAs(std::size_t i, bool outlier) const;
  /// A measurement as it was used.
  struct Used {
    LinearizedMeasurement z;
    Innovation innovation;
    RowJacobian HP;  ///< with P before the update
  };
  /// Updates with all measurements of the node; returns ln of the likelihood of
  /// those beside the fix.
  double UpdateAll(bool outlier, Gaussian* x) const;
  struct NodeLikelihood {
    FixLikelihood fix;    ///< zero of a node without one
    double others = 0.0;  ///< ln, of those beside the fix
    /// ln of the fix under the Gaussian, of a good fix or of an outlier, that the
    /// update uses in place of the mixture.
    double as_used = 0.0;
  };
  /// The same, the fix taken as LikelihoodOfFix has it. `used` gets what was used, if
  /// asked for.
  NodeLikelihood UpdateWithFix(ErrorStep step, Gaussian* x,
                               std::vector<Used>* used = nullptr) const;
  /// Updates with all measurements of the node but the fix.
  void UpdateOthers(Gaussian* x) const;
  bool IsFix(std::size_t i) const { return static_cast<int>(i) == fix_; }

 private:
  FixLikelihood Likelihood(const ErrorDynamics& d, ErrorStep step,
                           const FixView& view) const;
  /// With H P of the fix.
  FixLikelihood LikelihoodBy(const RowJacobian& HP, const Gaussian& x,
                             bool outlier) const;
  /// Of an innovation of covariance S + R, padded as FixView.
  FixLikelihood Weigh(const Eigen::Vector3d& innovation,
                      const Eigen::Matrix3d& S, bool outlier) const;
  /// Fills in all but what the fix is as a mixture.
  NodeLikelihood UpdateAll(bool outlier, Gaussian* x, std::vector<Used>* used,
                           const RowJacobian* HP_of_fix) const;

  /// Of an x that has of (e, r) so many components: e, or both.
  template <int kOwn>
  void PredictErrorBy(const ErrorDynamics& d, Gaussian* x) const;
  /// Adds a measurement of the node over (navigation, e, r).
  void Take(const TapeMeasurement& z);
  void AddNavigationNoise(ErrorMatrix* P) const;
  /// Before the node, as SensorTape::moved says.
  void AddVelocityStep(double variance, Onset onset, ErrorMatrix* P) const;

  const SensorTape& tape_;
  ErrorParameters parameters_;
  int navigation_dim_;
  int position_ = -1;  ///< offsets, or -1 if an axis is masked
  int velocity_ = -1;
  int own_field_ = -1;               ///< of the sensor's hard iron, or -1
  std::vector<double> noise_scale_;  ///< of SensorTape::noisy
  std::size_t k_ = 0;
  ErrorVector c_n_;
  double dt_ = 0.0;
  UnseenTime unseen_;             ///< of a drift
  int fix_ = -1;                  ///< index in z_
  int rows_ = 0;                  ///< of the fix
  Eigen::Matrix3d R_in_, R_out_;  ///< of the fix, padded, as an outlier
  Eigen::Matrix3d by_error_;      ///< derivative of the fix by e, padded
  std::vector<LinearizedMeasurement> z_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_ERROR_CHAIN_H_
