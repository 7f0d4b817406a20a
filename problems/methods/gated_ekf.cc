#include <utility>

#include "base/processor_time.h"
#include "filters/forward_filter.h"
#include "problems/method.h"
#include "problems/method_stage.h"
#include "problems/solution_builder.h"

namespace hindsight {
namespace {

Solution RunGatedEkf(MethodStage* stage) {
  constexpr double kGate = 0.999;
  const double t0 = ProcessorSeconds();
  ForwardStage& forward = stage->forward();
  Problem gated = forward.CausalProblem();
  for (std::size_t i = 0; i < gated.timeline.sensors().size(); ++i) {
    Sensor sensor = gated.timeline.sensors()[i];
    if (!sensor.gate_probability) sensor.gate_probability = kGate;
    gated.timeline.SetSensor(i, sensor);
  }
  Solution solution = FilterSolution(forward.Filter("gated_ekf", &gated));
  solution.seconds = ProcessorSeconds() - t0;
  return solution;
}

}  // namespace

extern const Method kGatedEkfMethod;
const Method kGatedEkfMethod = {
    .name = "gated_ekf",
    .help = "ekf, with a gate of 99.9 % where a sensor has none",
    .traits = TraitsOf({MethodTrait::kForward, MethodTrait::kDependsOnError}),
    .run = RunGatedEkf};

}  // namespace hindsight
