#include "problems/noise_likelihood.h"

#include <cmath>
#include <limits>

#include "base/error.h"
#include "filters/iterated_smoother.h"
#include "imu/imu_noise.h"
#include "measurements/sensor_kind.h"
#include "problems/clock_choice.h"
#include "problems/forward_stage.h"

namespace hindsight {

namespace {

/// With every clock where a reconstruction has it.
Dataset WithClocks(const Dataset& dataset) {
  const ClockChoice choice = ChooseClocks(dataset, {});
  return choice.dataset ? *choice.dataset : dataset;
}

}  // namespace

NoiseLikelihood::NoiseLikelihood(const Dataset& dataset)
    : dataset_(WithClocks(dataset)) {
  for (std::size_t i = 0; i < dataset_.streams.size(); ++i) {
    AidingStream& stream = dataset_.streams[i];
    stream.sensor.gate_probability.reset();
    stream.sensor.loss = RobustLoss();
    // The sigma of what is said beforehand is not fitted to the data.
    if (stream.sensor.kind->is_prior) continue;
    AddStream(static_cast<int>(i), &stream);
  }
  for (const ImuNoiseValue& value : ImuNoiseValues()) {
    if (!value.searched) continue;
    Add("imu." + std::string(value.name), &(dataset_.imu.noise.*value.at));
  }
  applied_.assign(values_.size(), 0.0);
  start_ = FindStart(dataset_, -std::numeric_limits<double>::infinity(),
                     std::numeric_limits<double>::infinity());
  for (const AidingStream& stream : dataset_.streams) {
    offsets_.push_back(stream.sensor.time_offset);
  }
  PlaceNodes(applied_);
}

bool NoiseLikelihood::PlaceNodes(const std::vector<double>& logs) {
  if (!EstimatesTimeOffsets(start_.layout)) return false;
  Apply(logs);
  Start start = start_;
  start.layout = PresentLayout(&start.prior);
  ForwardStage stage(dataset_, {}, std::move(start));
  stage.Settle(offsets_);
  const std::size_t last = stage.smoothed().states.size() - 1;
  const bool moved = FarthestFromNodes(stage.start().layout, offsets_,
                                       stage.smoothed().states[last],
                                       stage.smoothed().P.Get(last)) >= 0;
  offsets_ = stage.offsets();
  rates_ = stage.timeline().time_offset_rates();
  return moved;
}

void NoiseLikelihood::Apply(const std::vector<double>& logs) {
  for (std::size_t i = 0; i < logs.size(); ++i) {
    if (logs[i] != applied_[i]) {
      values_[i].multiply(std::exp(logs[i] - applied_[i]));
    }
  }
  applied_ = logs;
}

double NoiseLikelihood::operator()(const std::vector<double>& logs) {
  Apply(logs);
  TimelineOptions options;
  options.t_begin = start_.report.t;
  options.t_end = dataset_.imu.t_end();
  options.time_offsets = offsets_;
  Problem problem = {{}, start_.prior, BuildTimeline(dataset_, options)};
  if (!rates_.measurements.empty()) {
    problem.timeline.SetTimeOffsetRates(rates_);
  }
  problem.prior.x.t = problem.timeline.node(0).t;
  problem.layout = PresentLayout(&problem.prior);
  try {
    return LogLikelihoodOf(RunExtendedKalmanFilter(&problem));
  } catch (const EstimationError&) {
    return -std::numeric_limits<double>::infinity();
  }
}

void NoiseLikelihood::Add(const std::string& name, double* value) {
  values_.push_back({name, [value](double factor) { *value *= factor; }});
}

void NoiseLikelihood::AddStream(int index, AidingStream* stream) {
  Sensor& sensor = stream->sensor;
  if (!sensor.noise.correlated()) {
    values_.push_back({sensor.name, [stream](double factor) {
                         for (Measurement& z : stream->measurements.Edited()) {
                           ScaleSigma(factor, &z);
                         }
                       }});
  }
  for (const SensorBlock& block : sensor.kind->blocks) {
    if (block.searched == nullptr || !block.sigma(sensor, nullptr)) continue;
    for (const NoiseValue& value : block.searched(sensor)) {
      Add(sensor.name + "." + std::string(value.name), value.at(sensor));
    }
    errors_.push_back({index, &block});
  }
}

ErrorLayout NoiseLikelihood::PresentLayout(Prior* prior) const {
  ErrorLayout layout;
  for (Block block : start_.layout.blocks()) {
    for (const CorrelatedError& error : errors_) {
      if (block.key != BlockKey{error.block->kind, error.sensor}) continue;
      const Sensor& sensor =
          dataset_.streams[static_cast<std::size_t>(error.sensor)].sensor;
      block.evolution = error.block->evolution(sensor);
      block.sigma0 = *error.block->sigma(sensor, nullptr);
      prior->P.diagonal()
          .segment(block.offset, block.dim)
          .setConstant(block.sigma0.x() * block.sigma0.x());
    }
    layout.Add(block);
  }
  return layout;
}

}  // namespace hindsight
