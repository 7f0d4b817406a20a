#ifndef HINDSIGHT_FACTORS_IMU_FACTOR_H_
#define HINDSIGHT_FACTORS_IMU_FACTOR_H_

#include <memory>
#include <optional>

#include "factors/tangent_factor.h"
#include "timeline/distance_link.h"
#include "timeline/time_update.h"

namespace hindsight {

/// The IMU link between nodes k and k + 1: residual of EvaluateLink (position,
/// velocity, attitude; the biases' rows where they change with time), then one
/// defect x_{k+1} - phi x_k for every other block that changes with time, of
/// travelled distances that of their link (timeline/distance_link.h). All
/// whitened with the noise of the summary and of the evolutions; for blocks
/// that change with the distance travelled that distance is held fixed.
class ImuFactor : public TangentFactor {
 public:
  /// `timeline` must outlive the factor and have integrated its interval k; the
  /// factor keeps that summary. `distance`: Travelled of the interval [m],
  /// which only blocks that change with it need.
  ImuFactor(const StateBlocks* blocks, const Timeline* timeline, int k,
            double distance = 0.0);

  /// The whitening: a kilobyte, which takes a third of the time of a Linearize.
  void Keep() override;

 protected:
  void LinearizeStates(const std::vector<State>& states,
                       Eigen::Map<Eigen::VectorXd> residual,
                       Jacobian* J) const override;
  double NodeTime(int i) const override {
    return i == 0 ? summary_->t_i : summary_->t_j;
  }

 private:
  void LinearizeDistance(const StateBlocks::Entry& entry,
                         const std::vector<State>& states,
                         Eigen::Map<Eigen::VectorXd> residual,
                         Jacobian* J) const;
  /// Adds to the residual and its Jacobians what the rate of a step does.
  void LinearizeRate(const StateBlocks::Entry& entry, const BlockStep& step,
                     const std::vector<State>& states,
                     Eigen::Map<Eigen::VectorXd> residual, Jacobian* J) const;
  NodeInterval interval() const { return {timeline_, k_, *summary_}; }
  Eigen::MatrixXd OwnWhitener() const;

  const Timeline& timeline_;
  std::size_t k_;
  std::shared_ptr<const ImuSummary> summary_;
  double distance_;
  std::optional<PackedTriangle> whitener_;  ///< none: not kept
};

}  // namespace hindsight

#endif  // HINDSIGHT_FACTORS_IMU_FACTOR_H_
