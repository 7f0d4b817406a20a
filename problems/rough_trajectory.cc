#include "problems/rough_trajectory.h"

#include <utility>

#include "base/error.h"
#include "measurements/sensor_kind.h"
#include "problems/attitude_contradiction.h"
#include "problems/sensor_imm.h"

namespace hindsight {
namespace {

bool TellsHeading(const SensorKind& kind) {
  return kind.is_heading || kind.magnetic;
}

std::vector<int> HeadingSensors(const std::vector<Sensor>& sensors) {
  std::vector<int> all;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (TellsHeading(*sensors[i].kind)) all.push_back(static_cast<int>(i));
  }
  return all;
}

/// The decisions with every measurement of headings and magnetic fields left out;
/// empty if there is none.
GateDecisions WithoutHeadings(const Problem& problem) {
  GateDecisions decisions = problem.decisions;
  bool any = false;
  for (std::size_t i = 0; i < decisions.size(); ++i) {
    const Measurement& z = problem.timeline.all_measurements()[i];
    const auto sensor = static_cast<std::size_t>(z.sensor);
    if (!TellsHeading(*problem.timeline.sensors()[sensor].kind)) continue;
    any |= decisions[i] != 0;
    decisions[i] = 0;
  }
  return any ? decisions : GateDecisions();
}

}  // namespace

RoughTrajectory RoughlySolved(const MethodStage& stage,
                              const MethodStage::Nodes& nodes,
                              const Problem& problem, bool has_blunders) {
  const auto smooth = [&](const GateDecisions& decisions) {
    SensorImm imm = MakeSensorImm(stage.Questioned(nodes));
    if (!decisions.empty()) imm.options.decisions = decisions;
    return SmoothSensorImm(&imm, stage.forward().Progress("robust_batch"))
        .trajectory;
  };
  ImmTrajectory all =
      smooth(has_blunders ? problem.decisions : GateDecisions());
  const GateDecisions without = WithoutHeadings(problem);
  if (without.empty()) {
    return {.states = std::move(all.states), .P = std::move(all.P)};
  }
  try {
    ImmTrajectory moved = smooth(without);
    if (AttitudesContradict(problem.layout, all.states, moved.states,
                            moved.P)) {
      return {.states = std::move(moved.states),
              .P = std::move(moved.P),
              .contradicted = HeadingSensors(problem.timeline.sensors())};
    }
  } catch (const EstimationError&) {
    // What moves does not tell the attitude.
  }
  return {.states = std::move(all.states), .P = std::move(all.P)};
}

}  // namespace hindsight
