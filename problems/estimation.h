#ifndef HINDSIGHT_PROBLEMS_ESTIMATION_H_
#define HINDSIGHT_PROBLEMS_ESTIMATION_H_

#include <memory>
#include <vector>

#include "alignment/start.h"
#include "dataset/dataset.h"
#include "problems/method.h"
#include "problems/reconstruction.h"
#include "state/solution.h"

namespace hindsight {

/// What a Reconstruction is made of: all that its methods share. There is one
/// of position, velocity and attitude, and one of attitude alone.
class Estimation {
 public:
  virtual ~Estimation() = default;
  /// Runs a method that takes this kind of estimation.
  virtual Solution Run(const Method& method) = 0;
  /// nullptr where there is nothing to tell.
  virtual const StartReport* start() const = 0;
  virtual std::vector<UnobservedSpan> Unobserved() = 0;
  virtual std::vector<NormalisedInnovation> Innovations() { return {}; }
  virtual Solution Sample(const Solution& solution,
                          const std::vector<double>& times) const = 0;
};

/// Of position, velocity and attitude; errors as of Reconstruction. `dataset`
/// must outlive the object.
std::unique_ptr<Estimation> MakeTrajectoryEstimation(
    const Dataset& dataset, const ReconstructionOptions& options);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_ESTIMATION_H_
