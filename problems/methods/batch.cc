#include "problems/batch.h"

#include <utility>

#include "base/processor_time.h"
#include "problems/method.h"
#include "problems/method_stage.h"

namespace hindsight {
namespace {

Solution RunBatch(MethodStage* stage) {
  const double t0 = ProcessorSeconds();
  double beside = 0.0;
  Solution solution = stage->AtOwnNodes([&](const MethodStage::Nodes& nodes) {
    BatchResult result = stage->SolveBatch(nodes, &beside);
    Solution one = stage->FromSmoothed(std::move(result.states),
                                       std::move(result.P), nodes);
    one.iterations = result.iterations;
    one.converged = result.converged;
    stage->JudgeHeading(one, nodes);
    return one;
  });
  solution.seconds = ProcessorSeconds() - t0 + beside;
  stage->JudgeOptimum(solution);
  return solution;
}

}  // namespace

extern const Method kBatchMethod;
const Method kBatchMethod = {
    .name = "batch",
    .help = "nonlinear least squares over the whole interval",
    .traits =
        TraitsOf({MethodTrait::kFindsOptimum, MethodTrait::kDependsOnError,
                  MethodTrait::kSolvesBatch}),
    .run = RunBatch,
    .work = 12.0};

}  // namespace hindsight
