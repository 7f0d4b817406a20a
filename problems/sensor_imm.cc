#include "problems/sensor_imm.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "filters/iterated_smoother.h"
#include "measurements/sensor_kind.h"
#include "problems/solution_builder.h"

namespace hindsight {
namespace {

std::vector<int> QuestionedSensors(const Timeline& timeline) {
  std::vector<int> positions;
  std::vector<int> all;
  for (std::size_t i = 0; i < timeline.sensors().size(); ++i) {
    all.push_back(static_cast<int>(i));
    if (timeline.sensors()[i].kind->is_position) {
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

ImmModel Model(const Problem& problem, const std::vector<int>& questioned,
               const char* name, double factor) {
  ImmModel model;
  model.name = name;
  model.prior = problem.prior;
  for (Block block : problem.layout.blocks()) {
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
  model.sigma_factors.assign(problem.timeline.sensors().size(), 1.0);
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
  ModePart& modes = solution->modes.emplace();
  modes.probabilities = std::move(probabilities);
  for (const ImmModel& model : imm.models) modes.names.push_back(model.name);
  if (!imm.replaced.empty()) solution->notes.push_back(imm.replaced);
}

/// Takes the losses and gates of the questioned sensors away and names them.
std::string LeaveToModes(const std::vector<int>& questioned,
                         Timeline* timeline) {
  std::string names;
  for (const int i : questioned) {
    const auto index = static_cast<std::size_t>(i);
    Sensor sensor = timeline->sensors()[index];
    const bool has_loss = sensor.loss.kind != RobustLoss::Kind::kNone;
    if (!has_loss && !sensor.gate_probability) continue;
    names += (names.empty() ? "" : ", ") + sensor.name;
    sensor.loss = {};
    sensor.gate_probability.reset();
    timeline->SetSensor(index, sensor);
  }
  return names.empty()
             ? ""
             : "a loss or gate of " + names + ", which its modes replace";
}

void WeighByModes(const SensorImm& imm,
                  const std::vector<Eigen::VectorXd>& probabilities,
                  Solution* solution) {
  std::size_t i = 0;
  for (std::size_t k = 0; k < imm.problem.timeline.size(); ++k) {
    for (std::size_t n = 0; n < imm.problem.timeline.measurements(k).size();
         ++n) {
      ResidualRecord& record = solution->residuals[i++];
      record.weight *= WeightOf(imm, record.sensor, probabilities[k]);
    }
  }
}

}  // namespace

SensorImm MakeSensorImm(Problem problem) {
  const Timeline& timeline = problem.timeline;
  const std::vector<int> questioned = QuestionedSensors(timeline);
  const double factor =
      std::max(kPoorFactor, kPoorSigma / StatedPositionSigma(timeline));
  std::vector<ImmModel> models = {Model(problem, questioned, "good", 1.0),
                                  Model(problem, questioned, "poor", factor)};
  SensorImm imm{.models = std::move(models),
                .options = {},
                .problem = std::move(problem),
                .replaced = {}};
  imm.problem.decisions.clear();
  imm.replaced = LeaveToModes(questioned, &imm.problem.timeline);
  imm.options.transition = StayingTransition(2, 0.9);
  imm.options.start = Eigen::Vector2d(0.5, 0.5);
  imm.options.sensors = questioned;
  return imm;
}

ImmSmoothed SmoothSensorImm(SensorImm* imm, const EpochCallback& callback,
                            const std::function<void(const ImmTape&)>& judge) {
  Problem& problem = imm->problem;
  const GateDecisions given = imm->options.decisions;
  ImmResult result =
      RunImm(imm->models, imm->options, &problem.timeline, callback);
  problem.decisions = DecisionsOnTape(result.tape.tapes.front());
  ImmSmoothed smoothed = SmoothImm(result.tape);
  if (problem.timeline.HasGates()) {
    SmoothedTrajectory about;
    about.states = smoothed.trajectory.states;
    about.P = smoothed.trajectory.P;
    GateDecisions again = DecideGates(problem, about);
    for (std::size_t i = 0; i < given.size(); ++i) {
      if (given[i] == 0) again[i] = 0;
    }
    if (again != problem.decisions) {
      imm->options.decisions = again;
      problem.decisions = std::move(again);
      result = {};
      result = RunImm(imm->models, imm->options, &problem.timeline, callback);
      smoothed = SmoothImm(result.tape);
    }
  }
  if (judge) judge(result.tape);
  return smoothed;
}

Solution ImmFilterSolution(const SensorImm& imm, const ImmResult& result) {
  Solution solution = FilterSolution(result.tape.tapes.front());
  solution.states = result.trajectory.states;
  solution.covariances = result.trajectory.P;
  WeighByModes(imm, result.trajectory.probabilities, &solution);
  AddModes(imm, result.trajectory.probabilities, &solution);
  return solution;
}

Solution ImmSmootherSolution(const SensorImm& imm, ImmSmoothed smoothed) {
  ImmTrajectory& trajectory = smoothed.trajectory;
  Solution solution = SmoothedSolution(
      imm.problem, std::move(trajectory.states), std::move(trajectory.P));
  WeighByModes(imm, trajectory.probabilities, &solution);
  AddModes(imm, std::move(trajectory.probabilities), &solution);
  return solution;
}

}  // namespace hindsight
