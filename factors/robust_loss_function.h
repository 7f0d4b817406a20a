#ifndef HINDSIGHT_FACTORS_ROBUST_LOSS_FUNCTION_H_
#define HINDSIGHT_FACTORS_ROBUST_LOSS_FUNCTION_H_

#include <ceres/loss_function.h>

#include "measurements/robust_loss.h"

namespace hindsight {

/// A sensor's robust loss for Ceres. `widening` multiplies the scale:
/// graduated non-convexity begins wide, where the loss is nearly quadratic,
/// and comes down to 1 (Blake and Zisserman 1987; Yang et al. 2020).
class RobustLossFunction : public ceres::LossFunction {
 public:
  explicit RobustLossFunction(const RobustLoss& loss) : loss_(loss) {}

  void set_widening(double widening) { widening_ = widening; }
  RobustLoss loss() const {
    RobustLoss loss = loss_;
    loss.scale *= widening_;
    return loss;
  }

  void Evaluate(double s, double rho[3]) const override {
    const RobustLoss at = loss();
    rho[0] = at.Cost(s);
    rho[1] = at.Weight(s);
    rho[2] = at.Curvature(s);
  }

 private:
  RobustLoss loss_;
  double widening_ = 1.0;
};

}  // namespace hindsight

#endif  // HINDSIGHT_FACTORS_ROBUST_LOSS_FUNCTION_H_
