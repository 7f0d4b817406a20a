#include "problems/attitude.h"
#include "problems/method.h"

namespace hindsight {
namespace {

Solution RunFilter(AttitudeEstimation* estimation) {
  return estimation->Filter();
}

Solution RunSmoother(AttitudeEstimation* estimation) {
  return estimation->Smoother();
}

}  // namespace

extern const Method kAhrsMethod;
const Method kAhrsMethod = {
    .name = "ahrs",
    .help = "causal filter of attitude, gyro bias and gyro scale",
    .traits = TraitsOf({MethodTrait::kForward}),
    .run = RunFilter};

extern const Method kAhrsSmootherMethod;
const Method kAhrsSmootherMethod = {
    .name = "ahrs_smoother",
    .help =
        "its Rauch-Tung-Striebel smoother, which knows rest and field\n"
        "of the whole recording",
    .traits = 0,
    .run = RunSmoother};

}  // namespace hindsight
