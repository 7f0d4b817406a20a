#include "problems/reconstruction.h"

#include <optional>
#include <string>
#include <utility>

#include "alignment/gyro_drift.h"
#include "base/error.h"
#include "dataset/magnetic_check.h"
#include "dataset/repeated_readings.h"
#include "evaluation/grade.h"
#include "filters/heading_profile.h"
#include "problems/clock_choice.h"
#include "problems/disagreement.h"
#include "problems/forward_stage.h"
#include "problems/linearisation.h"
#include "problems/method.h"
#include "problems/method_stage.h"
#include "problems/sample_solution.h"

namespace hindsight {
namespace {

/// What the recording shows by itself, from the start to `to`.
std::vector<Evidence> ExamineRecording(const Dataset& dataset,
                                       const StartReport& start, double to) {
  std::vector<Evidence> all = FindRepeatedReadings(dataset, start.t, to);
  if (auto drift = FindGyroDrift(start, dataset.imu.noise)) {
    all.push_back(*std::move(drift));
  }
  for (std::string& warning : CheckMagnetometers(dataset)) {
    all.push_back({.rule = "magnetic_field",
                   .grade = Grade::kDoubtful,
                   .what = std::move(warning),
                   .is_cause = true});
  }
  return all;
}

}  // namespace

struct Reconstruction::Impl {
  Impl(const Dataset& dataset, const ReconstructionOptions& options)
      : clocks(ChooseClocks(dataset, options)),
        forward(*clocks.stage),
        recording(ExamineRecording(dataset, forward.start().report,
                                   forward.options().to)) {}

  Solution Finish(const Method& method, const MethodStage& stage,
                  Solution solution) {
    solution.method = method.name;
    solution.forward = method.Has(MethodTrait::kForward);
    solution.rivals = clocks.rivals;
    if (forward.turned_round()) {
      solution.rivals.push_back(*forward.turned_round());
      SetProbabilities(&solution.rivals);
    }
    const Start& start = forward.start();
    if (!solution.observer) {
      WidenHeading(solution.layout, stage.heading_credit(),
                   &solution.covariances);
    }
    Conclude({.solution = solution,
              .sensors = forward.timeline().sensors(),
              .start = StartValues{.x = start.prior.x,
                                   .P = start.prior.P,
                                   .given = forward.dataset().initial,
                                   .position = start.report.position,
                                   .alignment = start.report.alignment},
              .linearisation =
                  method.Has(MethodTrait::kLinearisesOnce)
                      ? LinearisationErrorOf(solution, forward.relinearised())
                      : std::nullopt,
              .unsettled = stage.unsettled(),
              .recording = recording,
              .disagreement = DisagreementOf(method, solution)},
             forward.unobserved(), &solution);
    return solution;
  }

  /// With a robust loss the two do not minimise the same cost.
  std::optional<Evidence> DisagreementOf(const Method& method,
                                         const Solution& solution) {
    if (!method.Has(MethodTrait::kFindsOptimum)) return std::nullopt;
    for (const Sensor& sensor : forward.timeline().sensors()) {
      if (sensor.loss.kind != RobustLoss::Kind::kNone) return std::nullopt;
    }
    return optima.Compare(method.name, solution);
  }

  ClockChoice clocks;
  ForwardStage& forward;
  std::vector<Evidence> recording;  ///< what it shows by itself
  OptimumComparison optima;
};

Reconstruction::Reconstruction(const Dataset& dataset,
                               ReconstructionOptions options)
    : impl_(std::make_unique<Impl>(dataset, options)) {}

Reconstruction::~Reconstruction() = default;

Solution Reconstruction::Run(const std::string& name) {
  const Method& method = MethodOf(name);
  if (method.reconstruct == nullptr) {
    throw InputError("method '" + name + "' estimates attitude alone");
  }
  impl_->forward.Run();
  MethodStage stage(&impl_->forward);
  Solution solution = method.reconstruct(&stage);
  return impl_->Finish(method, stage, std::move(solution));
}

std::vector<UnobservedSpan> Reconstruction::Unobserved() {
  impl_->forward.Run();
  return impl_->forward.unobserved();
}

const StartReport& Reconstruction::start() const {
  return impl_->forward.start().report;
}

Solution Reconstruction::Sample(const Solution& solution,
                                const std::vector<double>& times) const {
  const ReconstructionOptions& options = impl_->forward.options();
  const Method& method = MethodOf(solution.method);
  return SampleSolution(solution, impl_->forward.dataset().imu, times,
                        method.Has(MethodTrait::kHInfinity) ? options.h_infinity
                        : method.Has(MethodTrait::kModifiedHInfinity)
                            ? options.modified_h_infinity
                            : CovarianceOptions());
}

Solution Solve(const Dataset& dataset, const ReconstructionOptions& options) {
  Reconstruction reconstruction(dataset, options);
  return reconstruction.Run(options.method);
}

}  // namespace hindsight
