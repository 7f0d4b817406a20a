#include "problems/reconstruction.h"

#include <string>
#include <utility>

#include "base/error.h"
#include "problems/attitude.h"
#include "problems/estimation.h"

namespace hindsight {
namespace {

std::unique_ptr<Estimation> MakeEstimation(
    const Dataset& dataset, const ReconstructionOptions& options) {
  if (!options.attitude_alone) {
    return MakeTrajectoryEstimation(dataset, options);
  }
  return std::make_unique<AttitudeEstimation>(dataset, options);
}

}  // namespace

Reconstruction::Reconstruction(const Dataset& dataset,
                               const ReconstructionOptions& options)
    : attitude_alone_(options.attitude_alone),
      estimation_(MakeEstimation(dataset, options)) {}

Reconstruction::~Reconstruction() = default;

Solution Reconstruction::Run(const std::string& name) {
  const Method& method = MethodOf(name);
  if (method.attitude_alone() != attitude_alone_) {
    throw InputError("method '" + name + "' " +
                     (attitude_alone_ ? "does not estimate" : "estimates") +
                     " attitude alone");
  }
  return estimation_->Run(method);
}

std::vector<UnobservedSpan> Reconstruction::Unobserved() {
  return estimation_->Unobserved();
}

std::vector<NormalisedInnovation> Reconstruction::Innovations() {
  return estimation_->Innovations();
}

const StartReport* Reconstruction::start() const {
  return estimation_->start();
}

Solution Reconstruction::Sample(const Solution& solution,
                                const std::vector<double>& times) const {
  return estimation_->Sample(solution, times);
}

Solution Solve(const Dataset& dataset, const ReconstructionOptions& options) {
  Reconstruction reconstruction(dataset, options);
  return reconstruction.Run(options.method);
}

}  // namespace hindsight
