#include "problems/robust_batch.h"

#include <string>
#include <utility>

#include "base/error.h"
#include "base/processor_time.h"
#include "problems/error_tuning.h"
#include "problems/method.h"
#include "problems/method_stage.h"
#include "problems/sensor_imm.h"
#include "problems/solution_builder.h"

namespace hindsight {
namespace {

/// The first position sensor. Throws EstimationError where there is none, or
/// where its error has no room.
int Receiver(const MethodStage* stage) {
  int receiver = -1;
  for (std::size_t i = stage->forward().timeline().sensors().size(); i-- > 0;) {
    if (stage->forward().timeline().sensors()[i].type ==
        SensorType::kPosition) {
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

Solution SolveRobustly(int receiver, const MethodStage* stage,
                       const MethodStage::Nodes& nodes) {
  GateDecisions used = *nodes.decisions;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const Measurement& z = nodes.timeline->all_measurements()[i];
    if (z.sensor == receiver) used[i] = static_cast<char>(!z.withheld);
  }
  // The EKF's trajectory may be so far off after an outlier that a
  // linearisation about it is of no use.
  SensorImm imm = MakeSensorImm(stage->StartOfQuestioned(), *nodes.timeline);
  const ImmSmoothed rough =
      SmoothSensorImm(&imm, stage->forward().Progress("robust_batch")).smoothed;
  const Start start = WithoutTrustIn(receiver, stage->forward().start());
  RobustBatchResult result = SolveRobustBatch(
      start.layout, start.prior, rough.trajectory.states, receiver,
      *nodes.timeline, used, stage->MakeBatchOptions(),
      stage->forward().Progress("robust_batch"));
  Solution solution = SmoothedSolution(
      result.layout, result.timeline, std::move(result.batch.states),
      std::move(result.batch.P), result.decisions);
  std::size_t record = 0;
  for (std::size_t k = 0; k < result.timeline.size(); ++k) {
    for (const Measurement& z : result.timeline.measurements(k)) {
      ResidualRecord& r = solution.residuals[record++];
      if (z.sensor == receiver && !z.withheld) r.weight *= result.Trust(k);
    }
  }
  solution.iterations = result.batch.iterations;
  solution.converged = result.batch.converged;
  solution.mode_probabilities = std::move(result.probabilities);
  solution.mode_names = {"good", "biased", "drifting", "slight"};
  solution.notes = std::move(result.notes);
  const ScoredHistory& likeliest = result.regimes.histories.front();
  solution.bounded = BoundedParameters(likeliest.history, likeliest.parameters);
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
    .reconstruct = RunRobustBatch,
    .estimate_attitude = nullptr};

}  // namespace hindsight
