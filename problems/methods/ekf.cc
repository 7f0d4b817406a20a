#include "problems/forward_stage.h"
#include "problems/method.h"
#include "problems/method_stage.h"

namespace hindsight {
namespace {

Solution RunEkf(MethodStage* stage) { return stage->forward().TakeFiltered(); }

}  // namespace

extern const Method kEkfMethod;
const Method kEkfMethod = {
    .name = "ekf",
    .help = "forward error-state Kalman filter",
    .traits = TraitsOf({MethodTrait::kForward, MethodTrait::kLinearisesOnce,
                        MethodTrait::kDependsOnError}),
    .run = RunEkf};

}  // namespace hindsight
