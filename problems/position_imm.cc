#include "problems/position_imm.h"

#include "base/error.h"
#include "measurements/noise_kind.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

int FindStream(const Dataset& dataset, bool SensorKind::*is) {
  for (std::size_t i = 0; i < dataset.streams.size(); ++i) {
    if (dataset.streams[i].sensor.kind->*is) return static_cast<int>(i);
  }
  throw InputError("data set '" + dataset.name +
                   "' lacks a position or a height stream, which the "
                   "feed-forward IMM needs");
}

ErrorLayout Layout(const ErrorLayout& start, int receiver, double amplitude,
                   double beta) {
  ErrorLayout layout;
  for (Block block : start.blocks()) {
    if (block.key.kind == BlockKind::kPosition ||
        block.key.kind == BlockKind::kVelocity) {
      block.active[2] = false;
    }
    layout.Add(block);
  }
  Block noise;
  noise.key = {BlockKind::kColouredNoise, receiver};
  noise.name = "gnss_noise";
  noise.unit = "m";
  noise.evolution = Evolution::GaussMarkov(amplitude, 1.0 / beta);
  noise.sigma0.setConstant(amplitude);
  noise.active[2] = false;
  layout.Add(noise);
  return layout;
}

/// The start's prior over a layout with masked axes and blocks of its own.
Prior PriorOver(const ErrorLayout& layout, const Start& start) {
  Prior prior;
  prior.x = start.prior.x;
  prior.x.parameters.conservativeResize(layout.parameter_count());
  prior.x.parameters.tail<3>().setZero();
  prior.P = layout.InitialCovariance();
  const ComponentMap shared = SharedComponents(layout, start.layout);
  for (std::size_t i = 0; i < shared.size(); ++i) {
    for (std::size_t j = 0; j < shared.size(); ++j) {
      if (shared[i] < 0 || shared[j] < 0) continue;
      prior.P(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          start.prior.P(shared[i], shared[j]);
    }
  }
  return prior;
}

}  // namespace

std::vector<ImmModel> PositionImmModels(const Dataset& dataset,
                                        const Start& start,
                                        const PositionImmOptions& options) {
  const int receiver = FindStream(dataset, &SensorKind::is_position);
  FindStream(dataset, &SensorKind::is_height);
  std::vector<ImmModel> models;
  for (const double amplitude : options.amplitudes) {
    ImmModel& model = models.emplace_back();
    model.name = "A" + std::to_string(models.size() - 1);
    model.layout = Layout(start.layout, receiver, amplitude, options.beta);
    model.prior = PriorOver(model.layout, start);
  }
  return models;
}

ImmResult RunPositionImm(const Dataset& dataset, const Start& start,
                         const PositionImmOptions& options,
                         Timeline* timeline) {
  const auto count = static_cast<int>(options.amplitudes.size());
  ImmOptions imm;
  imm.transition = StayingTransition(count, options.stay);
  imm.start = Eigen::VectorXd::Constant(count, 1.0 / count);
  imm.sensors = {FindStream(dataset, &SensorKind::is_position)};
  imm.feedback = false;
  // The coloured states stand in place of the white R, not beside it.
  const auto receiver = static_cast<std::size_t>(imm.sensors.front());
  Sensor sensor = timeline->sensors()[receiver];
  sensor.noise.kind = &GaussMarkovNoise();
  sensor.noise.white_sigma = 0.0;
  timeline->SetSensor(receiver, sensor);
  return RunImm(PositionImmModels(dataset, start, options), imm, timeline);
}

}  // namespace hindsight
