#include <algorithm>
#include <optional>
#include <utility>

#include "base/processor_time.h"
#include "problems/fit.h"
#include "problems/linearisation.h"
#include "problems/method.h"
#include "problems/method_stage.h"
#include "problems/sensor_imm.h"

namespace hindsight {
namespace {

/// Takes out what the modes take for poor: that the stated model is wrong of it
/// is what the method is for.
void LeaveOutThePoor(const Solution& solution, SensorImm* imm) {
  const Timeline& timeline = imm->problem.timeline;
  GateDecisions& decisions = imm->problem.decisions;
  decisions.resize(timeline.all_measurements().size(), 1);
  for (std::size_t k = 0; k < timeline.size(); ++k) {
    if (solution.modes->probabilities[k](0) >= 0.5) continue;
    for (std::size_t i = 0; i < timeline.measurements(k).size(); ++i) {
      const int sensor = timeline.measurements(k)[i].sensor;
      if (std::find(imm->options.sensors.begin(), imm->options.sensors.end(),
                    sensor) == imm->options.sensors.end()) {
        continue;
      }
      decisions[static_cast<std::size_t>(timeline.node(k).first_measurement) +
                i] = 0;
    }
  }
}

/// Holds the innovations of all against the mixture that predicted them, and
/// what is left without the poor ones against the stated model.
void Judge(MethodStage* stage, const MethodStage::Nodes& nodes,
           const Solution& solution, Fit mixture, SensorImm* imm) {
  const ForwardStage& forward = stage->forward();
  LeaveOutThePoor(solution, imm);
  Fit fit;
  try {
    Rested rested =
        SmoothUntilItRests(solution.forward ? *nodes.states : solution.states,
                           &imm->problem, forward.Progress("linearisation"));
    Relinearised anew{
        .states = std::move(rested.trajectory.states),
        .variances = VariancesOf(solution.layout, rested.trajectory.P),
        .smoother = {}};
    fit = JudgeFit(forward.dataset(), anew, &imm->problem,
                   forward.Progress("grading"));
    if (!solution.forward) {
      LinearisationError error =
          Compare(solution.layout, solution.states, solution.covariances, anew);
      error.settled = rested.step < 1.0;
      stage->SetLinearisation(error);
    }
  } catch (const EstimationError&) {
    // Then it is not tested.
  }
  fit.innovations = std::move(mixture.innovations);
  fit.figures = std::move(mixture.figures);
  stage->SetFit(std::move(fit));
}

/// `solve` shows the tape of its mixture.
template <typename Solver>
Solution Mix(MethodStage* stage, bool forward, const Solver& solve) {
  const EpochCallback progress = stage->forward().Progress("imm");
  return stage->AtOwnNodes([&](const MethodStage::Nodes& nodes) {
    const double t0 = ProcessorSeconds();
    SensorImm imm = MakeSensorImm(stage->Questioned(nodes));
    std::optional<Fit> mixture;
    Solution solution = solve(&imm, progress, [&](const ImmTape& tape) {
      mixture =
          JudgeFit(stage->forward().dataset(), imm.problem.timeline, tape);
    });
    solution.seconds = ProcessorSeconds() - t0;
    solution.forward = forward;
    Judge(stage, nodes, solution, *std::move(mixture), &imm);
    return solution;
  });
}

Solution RunImmFilter(MethodStage* stage) {
  return Mix(
      stage, true,
      [](SensorImm* imm, const EpochCallback& progress, const auto& judge) {
        const ImmResult result =
            RunImm(imm->models, imm->options, &imm->problem.timeline, progress);
        judge(result.tape);
        return ImmFilterSolution(*imm, result);
      });
}

Solution RunImmSmoother(MethodStage* stage) {
  return Mix(
      stage, false,
      [](SensorImm* imm, const EpochCallback& progress, const auto& judge) {
        return ImmSmootherSolution(*imm, SmoothSensorImm(imm, progress, judge));
      });
}

}  // namespace

extern const Method kImmMethod;
const Method kImmMethod = {
    .name = "imm",
    .help =
        "two filters that mix: positions (without any, all measurements)\n"
        "are as good as stated, or twenty times worse, at least 20 m",
    .traits = TraitsOf({MethodTrait::kForward}),
    .run = RunImmFilter,
    .work = 4.0};

extern const Method kImmSmootherMethod;
const Method kImmSmootherMethod = {.name = "imm_smoother",
                                   .help = "the smoother of imm",
                                   .traits = 0,
                                   .run = RunImmSmoother,
                                   .work = 10.0};

}  // namespace hindsight
