#ifndef HINDSIGHT_FACTORS_IMU_FACTOR_H_
#define HINDSIGHT_FACTORS_IMU_FACTOR_H_

#include <memory>

#include "factors/tangent_factor.h"
#include "imu/imu_link.h"

namespace hindsight {

/// The IMU link between nodes k and k + 1: residual of EvaluateLink (position,
/// velocity, attitude; the biases' rows where they change with time), then one
/// defect x_{k+1} - phi x_k for every other block that changes with time. All
/// whitened with the noise of the summary and of the evolutions.
class ImuFactor : public TangentFactor {
 public:
  /// `summary` is referred to, not copied: it must outlive the factor and not
  /// be integrated anew meanwhile.
  ImuFactor(const StateBlocks* blocks, const ImuSummary* summary, int k);

 protected:
  void LinearizeStates(const std::vector<State>& states,
                       Eigen::Map<Eigen::VectorXd> residual,
                       Jacobian* J) const override;
  double NodeTime(int i) const override {
    return i == 0 ? summary_.t_i : summary_.t_j;
  }

 private:
  const ImuSummary& summary_;
  Eigen::MatrixXd whitener_;  ///< lower triangular
};

}  // namespace hindsight

#endif  // HINDSIGHT_FACTORS_IMU_FACTOR_H_
