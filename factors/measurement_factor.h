#ifndef HINDSIGHT_FACTORS_MEASUREMENT_FACTOR_H_
#define HINDSIGHT_FACTORS_MEASUREMENT_FACTOR_H_

#include "factors/tangent_factor.h"
#include "timeline/timeline.h"

namespace hindsight {

/// Any measurement model as a factor: residual -(measured - predicted) of the
/// model the filters use, whitened with its R. (The sign makes the Jacobian
/// equal to the filters' H.)
class MeasurementFactor : public TangentFactor {
 public:
  /// `timeline` and `z`, a measurement of its node k, must outlive the factor.
  MeasurementFactor(const StateBlocks* blocks, const Timeline* timeline, int k,
                    const Measurement* z);

 protected:
  void LinearizeStates(const std::vector<State>& states,
                       Eigen::Map<Eigen::VectorXd> residual,
                       Jacobian* J) const override;
  double NodeTime(int) const override;

 private:
  const Timeline& timeline_;
  std::size_t k_;
  const Measurement& z_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_FACTORS_MEASUREMENT_FACTOR_H_
