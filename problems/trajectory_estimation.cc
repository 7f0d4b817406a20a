#include <algorithm>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "alignment/gyro_drift.h"
#include "base/freed_memory.h"
#include "base/parallel.h"
#include "dataset/magnetic_check.h"
#include "dataset/repeated_readings.h"
#include "evaluation/grade.h"
#include "filters/heading_profile.h"
#include "imu/worst_drop_out.h"
#include "problems/clock_choice.h"
#include "problems/disagreement.h"
#include "problems/estimation.h"
#include "problems/exchanged_axes.h"
#include "problems/exchanged_places.h"
#include "problems/forward_stage.h"
#include "problems/imu_leaps.h"
#include "problems/linearisation.h"
#include "problems/method_stage.h"
#include "problems/sample_solution.h"

namespace hindsight {
namespace {

/// What the recording shows by itself.
struct Examined {
  std::vector<Evidence> evidence;
  std::optional<BridgedDropOut> worst_drop_out;
};

/// From the start to `to`.
Examined ExamineRecording(const Dataset& dataset, const StartReport& start,
                          double to) {
  Examined found{.evidence = FindRepeatedReadings(dataset, start.t, to),
                 .worst_drop_out = WorstDropOut(dataset.imu, start.t, to)};
  if (auto drift =
          FindGyroDrift(start, dataset.imu.noise, found.worst_drop_out)) {
    found.evidence.push_back(*std::move(drift));
  }
  for (std::string& warning : CheckMagnetometers(dataset)) {
    found.evidence.push_back({.rule = "magnetic_field",
                              .grade = Grade::kDoubtful,
                              .what = std::move(warning),
                              .is_cause = true});
  }
  return found;
}

class TrajectoryEstimation final : public Estimation {
 public:
  TrajectoryEstimation(const Dataset& dataset,
                       const ReconstructionOptions& options)
      : clocks_(ChooseClocks(dataset, options)),
        forward_(*clocks_.stage),
        recording_(InBackground([&dataset, this] {
                     return ExamineRecording(dataset, forward_.start().report,
                                             forward_.options().to);
                   }).share()) {}

  Solution Run(const Method& method) override {
    forward_.Run();
    SolveAhead(method);
    MethodStage stage(&clocks_, method.Has(MethodTrait::kSolvesBatch)
                                    ? ahead_.get()
                                    : nullptr);
    Solution solution = std::get<Method::OfTrajectory>(method.run)(&stage);
    timelines_.erase(method.name);
    if (auto own = stage.TakeTimeline()) {
      timelines_.emplace(method.name, *std::move(own));
    }
    return Finish(method, stage, std::move(solution));
  }

  const StartReport* start() const override { return &forward_.start().report; }

  std::vector<UnobservedSpan> Unobserved() override {
    forward_.Run();
    return forward_.unobserved();
  }

  std::vector<NormalisedInnovation> Innovations() override {
    forward_.Run();
    return forward_.fit().innovations;
  }

  Solution Sample(const Solution& solution,
                  const std::vector<double>& times) const override {
    const ReconstructionOptions& options = forward_.options();
    const Method& method = MethodOf(solution.method);
    return SampleSolution(
        solution, TimelineOf(solution.method), forward_.dataset().imu, times,
        method.Has(MethodTrait::kHInfinity) ? options.h_infinity
        : method.Has(MethodTrait::kModifiedHInfinity)
            ? options.modified_h_infinity
            : CovarianceOptions());
  }

 private:
  /// Begins with the batch beside what the first method's result is judged by, if it
  /// will be asked for later.
  void SolveAhead(const Method& judged) {
    if (begun_) return;
    begun_ = true;
    const std::vector<std::string>& methods = forward_.options().methods;
    const bool asked = std::any_of(
        methods.begin(), methods.end(), [](const std::string& name) {
          return MethodOf(name).Has(MethodTrait::kSolvesBatch);
        });
    if (!asked || judged.Has(MethodTrait::kSolvesBatch)) return;
    const std::vector<State>& start = forward_.batch_start();
    ReleaseFreedMemory();
    ahead_ = std::make_unique<BatchAhead>(
        start, MethodStage(&clocks_).MakeBatchOptions(), forward_.problem());
  }

  const Timeline& TimelineOf(const std::string& method) const {
    const auto own = timelines_.find(method);
    return own != timelines_.end() ? own->second : forward_.timeline();
  }

  /// Of the recording as it may be instead.
  static std::vector<RivalSolution> FindOtherData(ForwardStage* forward) {
    std::vector<RivalSolution> found = ImuLeaps(forward);
    for (const auto exchanged : {ExchangedPlaces, ExchangedAxes}) {
      for (RivalSolution& rival : exchanged(forward)) {
        found.push_back(std::move(rival));
      }
    }
    return found;
  }

  std::vector<RivalSolution> OtherData(ForwardStage* forward) {
    if (forward != &forward_) return FindOtherData(forward);
    if (!other_data_) other_data_ = FindOtherData(forward);
    return *other_data_;
  }

  std::vector<RivalSolution> Rivals(const MethodStage& stage) {
    std::vector<RivalSolution> rivals = stage.clocks().rivals;
    for (RivalSolution& rival : OtherData(&stage.forward())) {
      rivals.push_back(std::move(rival));
    }
    const auto& turned = stage.forward().turned_round();
    if (turned) rivals.push_back(*turned);
    SetProbabilities(&rivals);
    return rivals;
  }

  Solution Finish(const Method& method, const MethodStage& stage,
                  Solution solution) {
    solution.method = method.name;
    solution.forward = method.Has(MethodTrait::kForward);
    solution.rivals = Rivals(stage);
    ForwardStage& forward = stage.forward();
    const Start& start = forward.start();
    if (!solution.observer) {
      WidenHeading(solution.layout, stage.heading_credit(),
                   &solution.covariances);
    }
    Conclude(
        {.solution = solution,
         .sensors = TimelineOf(method.name).sensors(),
         .start = StartValues{.x = start.prior.x,
                              .P = start.prior.P,
                              .given = forward.dataset().initial,
                              .position = start.report.position,
                              .alignment = start.report.alignment},
         .linearisation =
             method.Has(MethodTrait::kLinearisesOnce)
                 ? LinearisationErrorOf(solution, forward.relinearised())
                 : stage.linearisation(),
         .untested = !stage.fit().tested,
         .innovations = stage.fit().figures,
         .explanations = stage.fit().explanations,
         .agreement = stage.fit().agreement,
         .contradiction =
             stage.fit().contradiction ? &*stage.fit().contradiction : nullptr,
         .constants = stage.fit().constants,
         .hindrance = Hindrance(),
         .unsettled = stage.unsettled(),
         .recording = recording_.get().evidence,
         .doubts = stage.doubts(),
         .disagreement = DisagreementOf(method, solution),
         .mounting_sigma = forward.dataset().mounting_sigma},
        forward.unobserved(), &solution);
    solution.compared = methods_.TooSure(solution);
    if (auto apart = methods_.Compare(solution)) {
      AddEvidence(*std::move(apart), &solution);
    }
    return solution;
  }

  const std::string& Hindrance() {
    if (!hindrance_) {
      hindrance_ = LostAttitude(recording_.get().worst_drop_out).value_or("");
    }
    return *hindrance_;
  }

  /// With a robust loss the two do not minimise the same cost.
  std::optional<Evidence> DisagreementOf(const Method& method,
                                         const Solution& solution) {
    if (!method.Has(MethodTrait::kFindsOptimum)) return std::nullopt;
    if (forward_.has_losses()) return std::nullopt;
    return optima_.Compare(method.name, solution);
  }

  ClockChoice clocks_;
  ForwardStage& forward_;
  /// FindOtherData of the stage that methods share.
  std::optional<std::vector<RivalSolution>> other_data_;
  /// Of any method; empty: none.
  std::optional<std::string> hindrance_;
  std::shared_future<Examined> recording_;
  bool begun_ = false;
  std::unique_ptr<BatchAhead> ahead_;  ///< null: not asked for
  OptimumComparison optima_;
  MethodComparison methods_{TrajectoryTerms()};
  /// Of methods that did not stay on the forward stage's, by name.
  std::map<std::string, Timeline> timelines_;
};

}  // namespace

std::unique_ptr<Estimation> MakeTrajectoryEstimation(
    const Dataset& dataset, const ReconstructionOptions& options) {
  return std::make_unique<TrajectoryEstimation>(dataset, options);
}

}  // namespace hindsight
