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
  Timeline gated = forward.timeline();
  for (std::size_t i = 0; i < gated.sensors().size(); ++i) {
    Sensor sensor = gated.sensors()[i];
    if (!sensor.gate_probability) sensor.gate_probability = kGate;
    gated.SetSensor(i, sensor);
  }
  Solution solution = FilterSolution(RunForwardFilter(
      {forward.options().error, {}}, stage->layout(), stage->prior(), &gated,
      {}, forward.Progress("gated_ekf")));
  solution.seconds = ProcessorSeconds() - t0;
  return solution;
}

}  // namespace

extern const Method kGatedEkfMethod;
const Method kGatedEkfMethod = {
    .name = "gated_ekf",
    .help = "ekf, with a gate of 99.9 % where a sensor has none",
    .traits = TraitsOf({MethodTrait::kForward, MethodTrait::kDependsOnError}),
    .reconstruct = RunGatedEkf,
    .estimate_attitude = nullptr};

}  // namespace hindsight
