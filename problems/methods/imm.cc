#include <utility>

#include "base/processor_time.h"
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
    // Of a mixture innovations are not normal.
    stage->SetFit({});
    return solve(&imm, progress);
  });
  solution.seconds = ProcessorSeconds() - t0;
  return solution;
}

Solution RunImmFilter(MethodStage* stage) {
  return Mix(stage, [](SensorImm* imm, const EpochCallback& progress) {
    return ImmFilterSolution(*imm, RunImm(imm->models, imm->options,
                                          &imm->problem.timeline, progress));
  });
}

Solution RunImmSmoother(MethodStage* stage) {
  return Mix(stage, [](SensorImm* imm, const EpochCallback& progress) {
    return ImmSmootherSolution(*imm, SmoothSensorImm(imm, progress));
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
