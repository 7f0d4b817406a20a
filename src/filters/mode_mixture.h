#ifndef HINDSIGHT_FILTERS_MODE_MIXTURE_H_
#define HINDSIGHT_FILTERS_MODE_MIXTURE_H_

#include <Eigen/Core>
#include <vector>

#include "filters/imm.h"

namespace hindsight {

/// The probabilities of a pass's models, a Markov chain, and the mixture that
/// their errors about one navigation nominal make. Of one model all of it is
/// that model.
class ModeMixture {
 public:
  /// Throws std::logic_error if a later layout has a navigation component that
  /// the first does not. `options` and `layouts` must outlive the object.
  ModeMixture(const ImmOptions& options,
              const std::vector<const ErrorLayout*>& layouts);

  std::size_t size() const { return shared_.size(); }
  const Eigen::VectorXd& probability() const { return mu_; }

  /// One step of the chain: mixes the errors (Baek 2019, eqs. (6) and (7)).
  void Switch(std::vector<Gaussian>* errors);

  /// Begins a node's update from the present probabilities.
  void BeginUpdate() { log_mu_ = mu_.array().log(); }
  /// Multiplies the probability of a model by a likelihood.
  void Weigh(std::size_t model, double log_likelihood) {
    log_mu_(static_cast<Eigen::Index>(model)) += log_likelihood;
  }
  /// Makes the probabilities sum to one; returns the logarithm of the sum since
  /// BeginUpdate. Throws EstimationError if nothing is left of it.
  double Normalize(double t);

  /// The mixture over the layout of a model; for the first, Baek 2019, eq.
  /// (12).
  Gaussian Combined(const std::vector<Gaussian>& errors,
                    std::size_t over = 0) const;
  /// By what each model's nominal is to be moved: the mean of the mixture over
  /// its layout. Components that the first model has too move by `combined`,
  /// the mixture over the first one's layout: their nominal is shared.
  std::vector<ErrorVector> Steps(const std::vector<Gaussian>& errors,
                                 const Gaussian& combined) const;

 private:
  std::vector<Gaussian> SeenBy(std::size_t j,
                               const std::vector<Gaussian>& errors) const;

  const ImmOptions& options_;
  std::vector<std::vector<ComponentMap>> shared_;  ///< of model j with each
  Eigen::VectorXd mu_;
  Eigen::VectorXd log_mu_;  ///< of the node's update so far, unscaled
};

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_MODE_MIXTURE_H_
