#ifndef HINDSIGHT_FILTERS_MEASUREMENT_RULE_H_
#define HINDSIGHT_FILTERS_MEASUREMENT_RULE_H_

#include <array>
#include <vector>

#include "filters/kalman.h"
#include "timeline/problem.h"

namespace hindsight {

/// Upper limit of the normalised innovation squared that the sensor's gate lets
/// pass for so many rows, infinity without a gate.
double GateLimit(const Sensor& sensor, int rows);

/// A sensor whose measurements hold under a hypothesis alone, that the vehicle
/// stands. They are used where the prediction without them is accurate enough
/// to decide for or against the hypothesis, and the sensor's gate lets them
/// pass.
struct Supposition {
  int sensor = -1;        ///< -1: none
  double known_to = 0.0;  ///< of every row, one sigma of the innovation
  /// The innovation's covariance is small enough to decide.
  template <typename Matrix>
  bool IsDecisive(const Matrix& S) const {
    return S.diagonal().maxCoeff() <= known_to * known_to;
  }
};

/// What a recursive filter makes of one measurement.
struct MeasurementVerdict {
  double weight = 1.0;   ///< of the sensor's loss; R is divided by it
  bool accepted = true;  ///< by the gate or the decision, and not withheld
};

/// How a recursive filter takes the sensors' robust losses and gates. The loss
/// divides R by its weight rho'(s), 1e-9 at least; s is the normalised
/// innovation squared, since a filter that only knows the past must allow for
/// its own uncertainty. About a fixed nominal s is that of the residual there,
/// which makes the pass a step of iteratively reweighted least squares. The
/// gate then tests the innovation with that R. The R of a withheld measurement
/// stays as it is.
class MeasurementRule {
 public:
  /// Keeps references to both; the losses and gates are those of now.
  MeasurementRule(const Timeline& timeline, const GateDecisions& decisions);

  void SetAboutFixedNominal(bool fixed) { fixed_nominal_ = fixed; }
  void Suppose(const Supposition& supposition) { supposition_ = supposition; }

  /// Whether measurement `index` of node k is used as far as it is decided
  /// beforehand: not withheld, nor decided against.
  bool MayUse(std::size_t k, int index) const;

  /// Whether the sensor has a loss, or a gate that is not decided beforehand.
  bool AsksTheInnovation(int sensor) const;

  /// Judges measurement `index` of node k, linearised as `z`, by what (dx, P)
  /// predict: divides z->R by the weight and gives the innovation with it.
  MeasurementVerdict Judge(std::size_t k, int index, const ErrorVector& dx,
                           const ErrorMatrix& P, LinearizedMeasurement* z,
                           Innovation* innovation) const;

 private:
  double RobustArgument(const LinearizedMeasurement& z,
                        const Innovation& innovation) const;
  bool Passes(int sensor, const Innovation& innovation) const;

  const Timeline& timeline_;
  const GateDecisions& decisions_;
  std::vector<std::array<double, kMaxRows>> gate_limits_;  // by sensor
  bool fixed_nominal_ = false;
  Supposition supposition_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_MEASUREMENT_RULE_H_
