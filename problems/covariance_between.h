#ifndef HINDSIGHT_PROBLEMS_COVARIANCE_BETWEEN_H_
#define HINDSIGHT_PROBLEMS_COVARIANCE_BETWEEN_H_

#include <cstddef>
#include <vector>

#include "filters/covariance_policy.h"
#include "imu/imu_link.h"
#include "imu/imu_stream.h"
#include "state/solution.h"
#include "timeline/timeline.h"

namespace hindsight {

/// P of a solution between its nodes, by the equations of SampleSolution: at
/// steps of at most kPropagationStep, linear in between.
class CovarianceBetween {
 public:
  /// All must outlive it.
  CovarianceBetween(const Solution& solution, const Timeline& timeline,
                    const ImuStream& imu, const CovarianceOptions& covariance);

  /// At t [s] between node k and the next.
  ErrorMatrix At(std::size_t k, double t);

 private:
  void StepFrom(std::size_t k);
  /// Calls `step` with the transition over each step and its length.
  template <typename Step>
  void ForEachStep(std::size_t k, const Step& step);
  /// Of a forward method.
  void Predict(std::size_t k);
  /// Of a smoother, as if the velocity did not step.
  void Bridge(std::size_t k);
  /// What steps of the velocity leave open between the nodes.
  void AddSteps(std::size_t k, double t, ErrorMatrix* P) const;

  const Solution& solution_;
  const Timeline& timeline_;
  ImuIntegrator integrator_;
  CovariancePolicy policy_;
  Transition transition_;
  std::size_t node_ = static_cast<std::size_t>(-1);
  std::vector<double> t_;       ///< times of node, steps and next node [s]
  std::vector<ErrorMatrix> P_;  ///< at these times
};

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_COVARIANCE_BETWEEN_H_
