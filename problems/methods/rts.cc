#include "problems/method.h"
#include "problems/method_stage.h"

namespace hindsight {
namespace {

Solution RunRts(MethodStage* stage) {
  const SmoothedTrajectory& smoothed = stage->forward().smoothed_once();
  Solution solution =
      stage->FromSmoothed(smoothed.states, smoothed.P, stage->SharedNodes());
  solution.seconds = stage->forward().smoothing_seconds();
  return solution;
}

}  // namespace

extern const Method kRtsMethod;
const Method kRtsMethod = {
    .name = "rts",
    .help = "ekf, smoothed by Rauch, Tung and Striebel's backward pass",
    .traits =
        TraitsOf({MethodTrait::kLinearisesOnce, MethodTrait::kDependsOnError}),
    .run = RunRts,
    .work = 2.0};

}  // namespace hindsight
