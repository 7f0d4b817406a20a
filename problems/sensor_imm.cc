#include "problems/sensor_imm.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "problems/solution_builder.h"

namespace hindsight {
namespace {

std::vector<int> QuestionedSensors(const Timeline& timeline) {
  std::vector<int> positions;
  std::vector<int> all;
  for (std::size_t i = 0; i < timeline.sensors().size(); ++i) {
    all.push_back(static_cast<int>(i));
    if (timeline.sensors()[i].type == SensorType::kPosition) {
      positions.push_back(static_cast<int>(i));
    }
  }
  return positions.empty() ? all : positions;
}

bool Contains(const std::vector<int>& list, int value) {
  for (const int item : list) {
    if (item == value) return true;
  }
  return false;
}

ImmModel Model(const Start& start, const Timeline& timeline,
               const std::vector<int>& questioned, const char* name,
               double factor) {
  ImmModel model;
  model.name = name;
  model.prior = start.prior;
  for (Block block : start.layout.blocks()) {
    const bool coloured = (block.key.kind == BlockKind::kColouredNoise ||
                           block.key.kind == BlockKind::kOffset) &&
                          Contains(questioned, block.key.sensor);
    if (coloured) {
      block.evolution.density *= factor;
      block.sigma0 *= factor;
    }
    model.layout.Add(block);
    if (!coloured) continue;
    const Block& added = model.layout.blocks().back();
    model.prior.P.block(added.offset, added.offset, added.dim, added.dim) *=
        factor * factor;
  }
  model.sigma_factors.assign(timeline.sensors().size(), 1.0);
  for (const int i : questioned) {
    model.sigma_factors[static_cast<std::size_t>(i)] = factor;
  }
  return model;
}

/// Root mean square of the stated sigmas of the position sensors, an axis [m];
/// infinite if there is none.
double StatedPositionSigma(const Timeline& timeline) {
  double sum = 0.0;
  int count = 0;
  for (const Measurement& z : timeline.all_measurements()) {
    const auto* fix = std::get_if<PositionFix>(&z.model);
    if (fix == nullptr) continue;
    sum += fix->R_n.trace() / 3.0;
    ++count;
  }
  return count == 0 ? std::numeric_limits<double>::infinity()
                    : std::sqrt(sum / count);
}

/// Mean of 1/factor^2 over the modes.
double WeightOf(const SensorImm& imm, int sensor, const Eigen::VectorXd& p) {
  double weight = 0.0;
  for (std::size_t j = 0; j < imm.models.size(); ++j) {
    const double factor =
        imm.models[j].sigma_factors[static_cast<std::size_t>(sensor)];
    weight += p(static_cast<Eigen::Index>(j)) / (factor * factor);
  }
  return weight;
}

void AddModes(const SensorImm& imm, std::vector<Eigen::VectorXd> probabilities,
              Solution* solution) {
  solution->mode_probabilities = std::move(probabilities);
  for (const ImmModel& model : imm.models) {
    solution->mode_names.push_back(model.name);
  }
}

}  // namespace

SensorImm MakeSensorImm(const Start& start, const Timeline& timeline,
                        const GateDecisions& decisions) {
  const std::vector<int> questioned = QuestionedSensors(timeline);
  const double factor =
      std::max(kPoorFactor, kPoorSigma / StatedPositionSigma(timeline));
  SensorImm imm;
  imm.models = {Model(start, timeline, questioned, "good", 1.0),
                Model(start, timeline, questioned, "poor", factor)};
  imm.options.transition = StayingTransition(2, 0.9);
  imm.options.start = Eigen::Vector2d(0.5, 0.5);
  imm.options.sensors = questioned;
  for (std::size_t i = 0; i < timeline.all_measurements().size(); ++i) {
    const Measurement& z = timeline.all_measurements()[i];
    const bool gated = !Contains(questioned, z.sensor) && !decisions.empty();
    imm.options.decisions.push_back(gated ? decisions[i]
                                          : static_cast<char>(!z.withheld));
  }
  return imm;
}

Solution ImmFilterSolution(const SensorImm& imm, const ImmResult& result) {
  Solution solution = FilterSolution(result.tape.tapes.front());
  solution.states = result.trajectory.states;
  solution.covariances = result.trajectory.P;
  std::size_t i = 0;
  for (std::size_t k = 0; k < result.tape.size(); ++k) {
    const auto count = result.tape.tapes.front().measurements(k).size();
    for (std::size_t n = 0; n < count; ++n) {
      ResidualRecord& record = solution.residuals[i++];
      record.weight =
          WeightOf(imm, record.sensor, result.trajectory.probabilities[k]);
    }
  }
  AddModes(imm, result.trajectory.probabilities, &solution);
  return solution;
}

Solution ImmSmootherSolution(const SensorImm& imm, const Timeline& timeline,
                             ImmSmoothed smoothed) {
  ImmTrajectory& trajectory = smoothed.trajectory;
  Solution solution = SmoothedSolution(
      imm.models.front().layout, timeline, std::move(trajectory.states),
      std::move(trajectory.P), imm.options.decisions);
  std::size_t i = 0;
  for (std::size_t k = 0; k < timeline.size(); ++k) {
    for (std::size_t n = 0; n < timeline.measurements(k).size(); ++n) {
      ResidualRecord& record = solution.residuals[i++];
      record.weight = WeightOf(imm, record.sensor, trajectory.probabilities[k]);
    }
  }
  AddModes(imm, std::move(trajectory.probabilities), &solution);
  return solution;
}

}  // namespace hindsight
