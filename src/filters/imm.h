#ifndef HINDSIGHT_FILTERS_IMM_H_
#define HINDSIGHT_FILTERS_IMM_H_

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "filters/forward_filter.h"
#include "filters/mixing.h"
#include "state/covariance_series.h"

namespace hindsight {

/// One model of an interacting-multiple-model filter: an error layout, with the
/// evolutions it believes in, and how far it trusts the sensors.
struct ImmModel {
  std::string name;
  ErrorLayout layout;
  Prior prior;  ///< over its layout; the navigation state is that of the first
  /// Factors on the standard deviations of each sensor; empty: all 1.
  std::vector<double> sigma_factors;
};

/// The defaults are those of one model.
struct ImmOptions {
  /// pi_ij, probability of model j after model i, at each node where the mode
  /// may switch. Rows sum to one.
  Eigen::MatrixXd transition = Eigen::MatrixXd::Ones(1, 1);
  /// Probabilities at the first node, sum one.
  Eigen::VectorXd start = Eigen::VectorXd::Ones(1);
  /// Sensors at whose measurements the mode may switch; empty: all of them.
  std::vector<int> sensors;
  /// True: the nominal is reset to the combined estimate at each node. False
  /// (feed-forward): it is the free inertial trajectory from the prior.
  bool feedback = true;
  /// The fixed nominal of the first nodes, or of all, a state a node with the
  /// parameters that all layouts then must have; there `feedback` is void, and
  /// its defects are c.
  std::span<const State> nominal;
  GateDecisions decisions;
};

/// What the filter knew of the mode at a node.
struct ImmEpoch {
  bool switched = false;        ///< the chain made a step before this node
  Eigen::VectorXd predicted;    ///< p(m_k = j | z_1 ... z_k-1)
  Eigen::VectorXd probability;  ///< p(m_k = j | z_1 ... z_k)
  /// ln p(z_k | z_1 ... z_k-1) of the node's measurements over all models.
  double log_likelihood = 0.0;
  /// Means after the update about x_plus, by model. They differ from zero even
  /// where the nominal was reset: the models share it.
  std::vector<ErrorVector> mean_plus;
};

/// A tape a model, about one navigation nominal, and the mode's probabilities.
struct ImmTape {
  std::vector<LinearTape> tapes;
  std::vector<ImmEpoch> epochs;
  Eigen::MatrixXd transition;

  std::size_t size() const { return epochs.size(); }
  double log_likelihood() const;
};

/// Combined estimates over the first model's layout.
struct ImmTrajectory {
  std::vector<State> states;
  CovarianceSeries P;  ///< in the tangent at the states
  std::vector<Eigen::VectorXd> probabilities;
};

struct ImmResult {
  ImmTape tape;
  ImmTrajectory trajectory;
};

/// Interacting-multiple-model filter (Blom and Bar-Shalom 1988; Baek 2019, eqs.
/// (6)-(12)) of any number of models over layouts of their own. All models are
/// errors about one navigation nominal, so that mixing is arithmetic in one
/// tangent; unequal layouts mix over what they share (filters/mixing.h). The
/// likelihoods (10) are multiplied in the logarithm. Gates and robust losses of
/// the sensors hold (MeasurementRule), but for all models alike, by what they
/// expect together - the mean and covariance of their mixture: what one model
/// rejects and another takes would leave nothing to compare. Of one model it is
/// the filter of filters/forward_filter.h: both are one walk.
///
/// A layout that masks the down axis of its position takes height and vertical
/// velocity of the nominal from the height measurements (filters/vertical.h).
///
/// Throws std::logic_error if there is no model, if a later model has a
/// navigation component that the first does not, or if parameters are not
/// those of `nominal`.
ImmResult RunImm(const std::vector<ImmModel>& models, const ImmOptions& options,
                 Timeline* timeline, const EpochCallback& callback = nullptr);

/// Probability of staying `stay` in each of `count` modes, and of changing to
/// each of the others in equal parts.
Eigen::MatrixXd StayingTransition(int count, double stay);

/// The combination of the models' distributions over the first one's layout.
Gaussian Combine(const std::vector<LinearTape>& tapes,
                 const std::vector<Gaussian>& models,
                 const Eigen::VectorXd& probability);

/// Appends the estimate `g` about `nominal` to a trajectory as epoch k.
void WriteCombined(const ErrorLayout& layout, const State& nominal,
                   const Gaussian& g, const Eigen::VectorXd& probability,
                   std::size_t k, ImmTrajectory* out);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_IMM_H_
