#include "problems/clocks_without.h"

#include <memory>

#include "base/error.h"

namespace hindsight {
namespace {

/// Withholds the measurements, or uses them again.
void Withhold(const std::set<MeasurementKey>& erring, bool withheld,
              Dataset* dataset) {
  for (AidingStream& stream : dataset->streams) {
    for (Measurement& z : stream.measurements.Edited()) {
      if (erring.contains({z.sensor, z.t})) z.withheld = withheld;
    }
  }
}

}  // namespace

std::optional<ClocksWithout> ChooseClocksWithout(
    const std::set<MeasurementKey>& erring, const Dataset& given,
    const ReconstructionOptions& options) {
  auto without = std::make_unique<Dataset>(given);
  Withhold(erring, true, without.get());
  try {
    ClockChoice choice = ChooseClocks(*without, options);
    choice.given = &given;
    if (!choice.dataset) choice.dataset = std::move(without);
    ForwardStage& stage = *choice.stage;
    stage.Run();
    Withhold(erring, false, choice.dataset.get());
    PlacedNodes nodes =
        stage.PlaceAnew(stage.offsets(), stage.problem(),
                        stage.problem().layout, stage.smoothed().states);
    GateDecisions& decisions = nodes.problem.decisions;
    for (std::size_t i = 0; i < decisions.size(); ++i) {
      const Measurement& z = nodes.problem.timeline.all_measurements()[i];
      if (erring.contains({z.sensor, z.t})) decisions[i] = 1;
    }
    return ClocksWithout{std::move(choice), std::move(nodes)};
  } catch (const EstimationError&) {
    return std::nullopt;
  }
}

}  // namespace hindsight
