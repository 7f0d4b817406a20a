#ifndef HINDSIGHT_FACTORS_PRIOR_FACTOR_H_
#define HINDSIGHT_FACTORS_PRIOR_FACTOR_H_

#include "factors/tangent_factor.h"

namespace hindsight {

/// What is known of node 0 and of every global beforehand: residual
/// Local(prior, x), whitened with P over the whole layout.
class PriorFactor : public TangentFactor {
 public:
  PriorFactor(const StateBlocks* blocks, const State& prior,
              const ErrorMatrix& P);

 protected:
  void LinearizeStates(const std::vector<State>& states,
                       Eigen::Map<Eigen::VectorXd> residual,
                       Jacobian* J) const override;
  double NodeTime(int) const override { return prior_.t; }

 private:
  State prior_;
  Eigen::MatrixXd whitener_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_FACTORS_PRIOR_FACTOR_H_
