#include <utility>

#include "base/processor_time.h"
#include "problems/fit.h"
#include "problems/method.h"
#include "problems/method_stage.h"
#include "problems/sensor_imm.h"

namespace hindsight {
namespace {

template <typename Solver>
Solution Mix(MethodStage* stage, const Solver& solve) {
  const double t0 = ProcessorSeconds();
  const EpochCallback progress = stage->forward().Progress("imm");
  Solution solution = stage->AtOwnNodes([&](const MethodStage::Nodes& nodes) {
    SensorImm imm = MakeSensorImm(stage->Questioned(nodes));
    const auto judge = [stage, &imm](const ImmTape& tape) {
      stage->SetFit(
          JudgeFit(stage->forward().dataset(), imm.problem.timeline, tape));
    };
    return solve(&imm, progress, judge);
  });
  solution.seconds = ProcessorSeconds() - t0;
  return solution;
}

Solution RunImmFilter(MethodStage* stage) {
  return Mix(stage, [](SensorImm* imm, const EpochCallback& progress,
                       const auto& judge) {
    const ImmResult result =
        RunImm(imm->models, imm->options, &imm->problem.timeline, progress);
    judge(result.tape);
    return ImmFilterSolution(*imm, result);
  });
}

Solution RunImmSmoother(MethodStage* stage) {
  return Mix(stage, [](SensorImm* imm, const EpochCallback& progress,
                       const auto& judge) {
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
