#ifndef HINDSIGHT_PROBLEMS_CHAIN_PROBLEM_H_
#define HINDSIGHT_PROBLEMS_CHAIN_PROBLEM_H_

#include <memory>
#include <vector>

#include "factors/robust_loss_function.h"
#include "factors/state_blocks.h"
#include "factors/tangent_factor.h"
#include "linear/arrow_least_squares.h"
#include "state/covariance_series.h"
#include "timeline/problem.h"

namespace hindsight {

/// The factors of a whole interval and the values of its parameter blocks.
class ChainProblem {
 public:
  /// Writes `states` into the parameter blocks; summaries are those of the
  /// problem's timeline, integrated at the states' calibration where needed.
  /// The problem must outlive the object. Throws std::logic_error for states whose
  /// parameters are not those of the problem's layout.
  ChainProblem(const std::vector<State>& states, Problem* problem);

  const StateBlocks& blocks() const { return *blocks_; }
  const std::vector<std::unique_ptr<TangentFactor>>& factors() const {
    return factors_;
  }
  /// TangentFactor::Keep of all: before they are linearised again and again.
  void KeepFactors();
  /// The loss of factor i, or nullptr.
  RobustLossFunction* loss(std::size_t i) { return losses_[i].get(); }
  bool HasLoss() const;
  /// Largest |whitened residual| in units of its loss's scale, over all factors
  /// whose loss redescends; 0 if there is none.
  double LargestRobustRatio();
  /// Widens the scale of every loss that redescends.
  void SetWidening(double widening);

  std::size_t node_count() const { return times_.size(); }
  double* node_values(std::size_t k) {
    return nodes_.data() +
           k * static_cast<std::size_t>(blocks_->node_ambient_dim());
  }
  double* global_values(std::size_t g) { return globals_[g].data(); }
  /// Parameter blocks of a factor, in its order.
  std::vector<double*> ParametersOf(const TangentFactor& factor);

  std::vector<State> States() const;
  /// Writes `states` into the parameter blocks; throws as the constructor.
  void Set(const std::vector<State>& states);

  /// All factors linearised at the present values, of which the solution is one
  /// Gauss-Newton step, solved. Throws EstimationError where they leave an
  /// unknown undetermined. From the second on factors are kept.
  ArrowLeastSquares GaussNewtonStep();
  /// Half the sum of the losses of the squared residuals where the last step was
  /// linearised.
  double linearized_cost() const { return linearized_cost_; }
  /// Root mean square a node of a step, over metres, m/s, radians and the rest.
  double StepSize(const ArrowLeastSquares& step) const;
  /// Moves the values by a step, or a part of it.
  void Apply(const ArrowLeastSquares& step, double part = 1.0);
  /// Marginal covariances over the layout, of the values that the step was
  /// linearised at.
  CovarianceSeries Marginals(const ArrowLeastSquares& step) const;

 private:
  /// Factor i at the present values, weighted by its loss. Returns the loss.
  double Linearize(std::size_t i, TangentFactor::Jacobian* J,
                   Eigen::VectorXd* residual);

  std::unique_ptr<StateBlocks> blocks_;
  std::vector<double> times_;
  std::vector<double> nodes_;
  std::vector<std::vector<double>> globals_;
  std::vector<std::unique_ptr<TangentFactor>> factors_;
  std::vector<std::unique_ptr<RobustLossFunction>> losses_;  // one a factor
  bool is_kept_ = false;
  int steps_ = 0;
  double linearized_cost_ = 0.0;
};

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_CHAIN_PROBLEM_H_
