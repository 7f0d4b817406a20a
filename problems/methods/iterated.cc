#include <utility>

#include "base/processor_time.h"
#include "filters/iterated_smoother.h"
#include "problems/method.h"
#include "problems/method_stage.h"

namespace hindsight {
namespace {

Solution RunIterated(MethodStage* stage) {
  const double t0 = ProcessorSeconds();
  ForwardStage& forward = stage->forward();
  IterationOptions iteration;
  iteration.max_iterations = forward.options().max_iterations;
  iteration.callback = forward.Progress("iterated");
  Solution solution = stage->AtOwnNodes([&](const MethodStage::Nodes& nodes) {
    IteratedResult result =
        SmoothIterated(*nodes.states, iteration, nodes.problem);
    Solution one = stage->FromSmoothed(std::move(result.trajectory.states),
                                       std::move(result.trajectory.P), nodes);
    one.iterations = result.iterations;
    one.converged = result.converged;
    stage->JudgeHeading(one, nodes);
    return one;
  });
  solution.seconds = ProcessorSeconds() - t0;
  stage->JudgeOptimum(solution);
  return solution;
}

}  // namespace

extern const Method kIteratedMethod;
const Method kIteratedMethod = {
    .name = "iterated",
    .help = "rts, linearised anew about its result until it rests",
    .traits =
        TraitsOf({MethodTrait::kFindsOptimum, MethodTrait::kDependsOnError}),
    .run = RunIterated,
    .work = 8.0};

}  // namespace hindsight
