#include "problems/node_placement.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "problems/sample_solution.h"

namespace hindsight {
namespace {

/// The trajectory at the nodes of another timeline, over the blocks of `base`.
std::vector<State> StatesAt(const Timeline& to, const ErrorLayout& base,
                            const ErrorLayout& layout,
                            const std::vector<State>& states,
                            const Timeline& from, const ImuStream& imu) {
  std::vector<double> times;
  for (const Node& node : to.nodes()) times.push_back(node.t);
  Solution solution;
  solution.layout = layout;
  solution.states = states;
  std::vector<State> moved = SampleSolution(solution, from, imu, times).states;
  for (State& x : moved) {
    x.parameters.conservativeResize(base.parameter_count());
  }
  return moved;
}

/// The decisions on another timeline's measurements; those of a sensor are in
/// the order of their stamps on both. What is new is used.
GateDecisions CarryDecisions(const Timeline& from,
                             const GateDecisions& decisions,
                             const Timeline& to) {
  if (decisions.empty()) return {};
  std::vector<std::vector<std::pair<double, char>>> known(
      from.sensors().size());
  for (std::size_t i = 0; i < decisions.size(); ++i) {
    const Measurement& z = from.all_measurements()[i];
    known[static_cast<std::size_t>(z.sensor)].push_back({z.t, decisions[i]});
  }
  std::vector<std::size_t> next(known.size(), 0);
  GateDecisions carried;
  for (const Measurement& z : to.all_measurements()) {
    const auto sensor = static_cast<std::size_t>(z.sensor);
    const auto& list = known[sensor];
    std::size_t& i = next[sensor];
    while (i < list.size() && list[i].first < z.t) ++i;
    const bool found = i < list.size() && list[i].first == z.t;
    carried.push_back(found ? list[i++].second
                            : static_cast<char>(!z.withheld));
  }
  return carried;
}

}  // namespace

bool EstimatesTimeOffsets(const ErrorLayout& layout) {
  return std::any_of(layout.blocks().begin(), layout.blocks().end(),
                     [](const Block& block) {
                       return block.key.kind == BlockKind::kTimeOffset;
                     });
}

int FarthestFromNodes(const ErrorLayout& layout,
                      const std::vector<double>& offsets, const State& x,
                      const ErrorMatrix& P, double least) {
  double farthest = least;
  int sensor = -1;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const Block* block =
        layout.Find(BlockKind::kTimeOffset, static_cast<int>(i));
    if (block == nullptr) continue;
    const double step =
        std::abs(x.parameters(block->parameter_offset) - offsets[i]) /
        std::sqrt(P(block->offset, block->offset));
    if (step < farthest) continue;
    farthest = step;
    sensor = static_cast<int>(i);
  }
  return sensor;
}

std::vector<double> OffsetSearch::Next(const ErrorLayout& layout,
                                       const std::vector<Sensor>& sensors,
                                       const State& x,
                                       const std::vector<double>& placed) {
  std::vector<double> next = placed;
  std::vector<double> steps(placed.size(), 0.0);
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const Block* block =
        layout.Find(BlockKind::kTimeOffset, static_cast<int>(i));
    if (block == nullptr) continue;
    steps[i] = x.parameters(block->parameter_offset) - placed[i];
    if (!std::isfinite(steps[i])) {
      throw EstimationError("the time offset of " + sensors[i].name +
                            " diverged");
    }
    const bool turned = !steps_.empty() && steps_[i] * steps[i] < 0.0 &&
                        placed[i] != placed_[i];
    next[i] +=
        turned ? steps[i] * (placed[i] - placed_[i]) / (steps_[i] - steps[i])
               : steps[i];
  }
  placed_ = placed;
  steps_ = std::move(steps);
  return next;
}

PlacedNodes PlaceNodesAnew(const Dataset& dataset,
                           const TimelineOptions& options,
                           const Problem& problem, const ErrorLayout& layout,
                           const std::vector<State>& states) {
  PlacedNodes nodes{
      options.time_offsets,
      {problem.layout, problem.prior, BuildTimeline(dataset, options)},
      {}};
  Timeline& timeline = nodes.problem.timeline;
  nodes.states = StatesAt(timeline, problem.layout, layout, states,
                          problem.timeline, dataset.imu);
  timeline.LinearizeTimeOffsets(problem.layout, nodes.states);
  nodes.problem.decisions =
      CarryDecisions(problem.timeline, problem.decisions, timeline);
  return nodes;
}

}  // namespace hindsight
