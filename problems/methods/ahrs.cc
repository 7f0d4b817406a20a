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

Solution RunRoomBatch(AttitudeEstimation* estimation) {
  return estimation->RoomBatch();
}

Solution RunTiltBatch(AttitudeEstimation* estimation) {
  return estimation->TiltBatch();
}

}  // namespace

extern const Method kAhrsMethod;
const Method kAhrsMethod = {
    .name = "ahrs",
    .help = "causal filter of attitude and gyro bias at every sample",
    .traits = 0,
    .reconstruct = nullptr,
    .estimate_attitude = RunFilter};

extern const Method kAhrsSmootherMethod;
const Method kAhrsSmootherMethod = {
    .name = "ahrs_smoother",
    .help = "the Rauch-Tung-Striebel smoother of ahrs",
    .traits = 0,
    .reconstruct = nullptr,
    .estimate_attitude = RunSmoother};

extern const Method kAhrsBatchMethod;
const Method kAhrsBatchMethod = {
    .name = "ahrs_batch",
    .help = "least squares with the linear acceleration as unknown",
    .traits = 0,
    .reconstruct = nullptr,
    .estimate_attitude = RunRoomBatch};

extern const Method kAhrsTiltBatchMethod;
const Method kAhrsTiltBatchMethod = {
    .name = "ahrs_tilt_batch",
    .help = "least squares with the linear acceleration as noise",
    .traits = 0,
    .reconstruct = nullptr,
    .estimate_attitude = RunTiltBatch};

}  // namespace hindsight
