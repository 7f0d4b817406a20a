#include "filters/two_filter.h"

#include <utility>

#include "base/processor_time.h"
#include "problems/method.h"
#include "problems/method_stage.h"
#include "problems/single_pass.h"

namespace hindsight {
namespace {

/// The RTS pass has released the forward stage's tape. Filtering again with the
/// same gate decisions costs less than keeping the tape would.
template <typename Smoother>
Solution Fuse(MethodStage* stage, const Smoother& smooth) {
  ForwardStage& forward = stage->forward();
  const LinearTape tape = forward.FilterOnce("two_filter");
  const double t0 = ProcessorSeconds();
  TwoFilterResult result = smooth(tape);
  SmoothedTrajectory& trajectory = result.trajectory;
  MoveToSmoothed(stage->layout(), NominalOf(tape), &trajectory);
  const double seconds = ProcessorSeconds() - t0;
  Solution solution =
      stage->FromSmoothed(std::move(trajectory.states), std::move(trajectory.P),
                          stage->SharedNodes());
  solution.two_filter = std::move(result.part);
  solution.seconds = seconds;
  return solution;
}

Solution RunTwoFilter(MethodStage* stage) {
  return Fuse(stage,
              [](const LinearTape& tape) { return SmoothTwoFilter(tape); });
}

template <ChartKind kChart>
Solution RunConventional(MethodStage* stage) {
  return Fuse(stage, [](const LinearTape& tape) {
    return SmoothTwoFilterConventional(tape, kChart);
  });
}

constexpr unsigned kTraits =
    TraitsOf({MethodTrait::kLinearisesOnce, MethodTrait::kDependsOnError});

}  // namespace

extern const Method kTwoFilterMethod;
const Method kTwoFilterMethod = {
    .name = "two_filter",
    .help =
        "ekf, fused with a backward information filter in error form;\n"
        "`separation` is the distance of forward and backward positions\n"
        "in sigmas",
    .traits = kTraits,
    .run = RunTwoFilter,
    .work = 3.0};

extern const Method kTwoFilterConventionalMethod;
const Method kTwoFilterConventionalMethod = {
    .name = "two_filter_conventional",
    .help = "two_filter in the full state, in metres and small angles",
    .traits = kTraits,
    .run = RunConventional<ChartKind::kAdditive>,
    .work = 3.0};

extern const Method kTwoFilterEulerMethod;
const Method kTwoFilterEulerMethod = {
    .name = "two_filter_euler",
    .help = "two_filter in latitude, longitude and Euler angles",
    .traits = kTraits,
    .run = RunConventional<ChartKind::kEuler>,
    .work = 3.0};

}  // namespace hindsight
