#include "problems/robust_batch.h"

#include <string>
#include <utility>

#include "base/error.h"
#include "base/processor_time.h"
#include "measurements/sensor_kind.h"
#include "problems/method.h"
#include "problems/method_stage.h"
#include "problems/sensor_imm.h"
#include "problems/solution_builder.h"
#include "receiver_errors/receiver_errors.h"

namespace hindsight {
namespace {

/// The first position sensor. Throws EstimationError if there is none, or if
/// the states of its error would be more than a state can hold.
int Receiver(const MethodStage* stage) {
  int receiver = -1;
  for (std::size_t i = stage->forward().timeline().sensors().size(); i-- > 0;) {
    if (stage->forward().timeline().sensors()[i].kind->is_position) {
      receiver = static_cast<int>(i);
    }
  }
  if (receiver < 0) {
    throw EstimationError("robust_batch needs a position sensor");
  }
  constexpr int kOwnStates = 6;
  if (stage->layout().parameter_count() + kOwnStates > kMaxParameters) {
    throw EstimationError(
        "robust_batch adds 6 values to those estimated: expected at most " +
        std::to_string(kMaxParameters - kOwnStates) + " of them");
  }
  return receiver;
}

/// The problem with every fix of the receiver used, whatever gates decided, and
/// a prior that does not trust the fix from which the start comes.
Problem WithAllOf(int receiver, const MethodStage* stage, Problem problem) {
  for (std::size_t i = 0; i < problem.decisions.size(); ++i) {
    const Measurement& z = problem.timeline.all_measurements()[i];
    if (z.sensor == receiver) {
      problem.decisions[i] = static_cast<char>(!z.withheld);
    }
  }
  problem.prior = WithoutTrustIn(receiver, stage->forward().start()).prior;
  return problem;
}

Solution SolveRobustly(int receiver, MethodStage* stage,
                       const MethodStage::Nodes& nodes) {
  // The EKF's trajectory may be so far off after an outlier that a
  // linearisation about it is of no use.
  SensorImm imm = MakeSensorImm(stage->Questioned(nodes));
  const ImmSmoothed rough =
      SmoothSensorImm(&imm, stage->forward().Progress("robust_batch"));
  RobustBatchResult result = SolveRobustBatch(
      WithAllOf(receiver, stage, *nodes.problem), rough.trajectory.states,
      receiver, stage->MakeBatchOptions(),
      stage->forward().Progress("robust_batch"));
  Solution solution =
      SmoothedSolution(result.problem, std::move(result.batch.states),
                       std::move(result.batch.P));
  Timeline& timeline = result.problem.timeline;
  stage->SetFit(
      JudgeFit(stage->forward().dataset(),
               {.states = solution.states,
                .variances = VariancesOf(solution.layout, solution.covariances),
                .smoother = {}},
               &result.problem, stage->forward().Progress("grading")));
  std::size_t record = 0;
  for (std::size_t k = 0; k < timeline.size(); ++k) {
    for (const Measurement& z : timeline.measurements(k)) {
      ResidualRecord& r = solution.residuals[record++];
      if (z.sensor == receiver && !z.withheld) r.weight *= result.trust[k];
    }
  }
  solution.iterations = result.batch.iterations;
  solution.converged = result.batch.converged;
  solution.modes = std::move(result.modes);
  solution.notes = std::move(result.notes);
  solution.bounded = std::move(result.bounded);
  stage->SetTimeline(std::move(timeline));
  return solution;
}

Solution RunRobustBatch(MethodStage* stage) {
  const double t0 = ProcessorSeconds();
  const int receiver = Receiver(stage);
  Solution solution = stage->AtOwnNodes([&](const MethodStage::Nodes& nodes) {
    return SolveRobustly(receiver, stage, nodes);
  });
  solution.seconds = ProcessorSeconds() - t0;
  return solution;
}

}  // namespace

extern const Method kRobustBatchMethod;
const Method kRobustBatchMethod = {
    .name = "robust_batch",
    .help =
        "batch that finds out from the data whether positions have\n"
        "outliers, correlated errors or jumps",
    .traits = 0,
    .run = RunRobustBatch,
    .work = 200.0};

}  // namespace hindsight
