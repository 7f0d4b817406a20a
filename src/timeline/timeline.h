#ifndef HINDSIGHT_TIMELINE_TIMELINE_H_
#define HINDSIGHT_TIMELINE_TIMELINE_H_

#include <future>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "imu/preintegration.h"
#include "measurements/measurement.h"
#include "state/block_step.h"
#include "timeline/velocity_step.h"

namespace hindsight {

/// An instant at which the state is estimated.
struct Node {
  double t = 0.0;
  Kinematics kinematics;
  int first_measurement = 0;  ///< range in Timeline::measurements
  int measurement_count = 0;
};

/// A count of an odometer with which an increment begins, at a node.
struct IncrementStart {
  int node = 0;
  int sensor = 0;
  double stamp = 0.0;  ///< of the count [s]
  /// Speed of the axle along a known trajectory [m/s], as
  /// ModelContext::offset_rate.
  std::optional<double> offset_rate;
};

/// Rates of the predictions with estimated time offsets: one a measurement,
/// empty where its sensor's is not estimated, and one an increment's start.
struct TimeOffsetRates {
  std::vector<RowVector> measurements;
  std::vector<std::optional<double>> increment_starts;
};

/// What every estimator works on: nodes in time order, the measurements of each
/// and the IMU summary of each interval between neighbours. A summary never
/// changes: one of another calibration takes its place where Integrate finds
/// that the calibration has moved too far. Copies of a timeline share them.
class Timeline {
 public:
  Timeline(std::vector<Node> nodes, std::vector<Measurement> measurements,
           std::vector<Sensor> sensors, const ImuStream& imu,
           bool with_scale_jacobians);

  std::size_t size() const { return nodes_.size(); }
  const Node& node(std::size_t k) const { return nodes_[k]; }
  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<Sensor>& sensors() const { return sensors_; }
  std::span<const Measurement> measurements(std::size_t k) const {
    return std::span<const Measurement>(measurements_)
        .subspan(static_cast<std::size_t>(nodes_[k].first_measurement),
                 static_cast<std::size_t>(nodes_[k].measurement_count));
  }
  const std::vector<Measurement>& all_measurements() const {
    return measurements_;
  }

  /// Readings of the IMU, which are best asked for in order of time.
  ImuIntegrator Readings() const { return integrator_; }
  /// Of the IMU [s].
  double sample_interval() const { return sample_interval_; }

  /// The count at node k with which the sensor's next increment begins, or
  /// nullptr.
  const IncrementStart* IncrementStartAt(std::size_t k, int sensor) const;
  /// In the order of nodes.
  void SetIncrementStarts(std::vector<IncrementStart> starts) {
    increment_starts_ = std::move(starts);
  }

  /// Summary of the interval from node k to k + 1, integrated at `calibration`
  /// or near enough for its first-order correction (NeedsReintegration). Where
  /// the present one is not, a new one takes its place. Where there is none yet,
  /// some of those behind it are integrated beside at the same calibration; which,
  /// and at which, does not depend on the number of threads.
  const ImuSummary& Integrate(std::size_t k, const ImuCalibration& calibration);

  /// The present summary; it must have been integrated before.
  const ImuSummary& Summary(std::size_t k) const { return *summaries_[k]; }
  /// The same, to keep it whatever is integrated later.
  std::shared_ptr<const ImuSummary> SharedSummary(std::size_t k) const {
    return summaries_[k];
  }

  /// Linearises the estimated time offsets along a trajectory, a state a node.
  /// From here on every method takes them by these rates, until others are set;
  /// before, as noise (Evaluate).
  void LinearizeTimeOffsets(const ErrorLayout& layout,
                            std::span<const State> states);
  /// The rates, to carry them to a timeline with the same nodes.
  const TimeOffsetRates& time_offset_rates() const { return offset_rates_; }
  void SetTimeOffsetRates(TimeOffsetRates rates);

  /// Gives blocks a step of their own for each interval, in place of their
  /// evolution; as many as intervals, or none to take them back.
  void SetBlockSteps(std::vector<std::vector<BlockStep>> steps) {
    block_steps_ = std::move(steps);
  }
  /// The block steps of the interval after node k.
  std::span<const BlockStep> StepsAfter(std::size_t k) const {
    if (block_steps_.empty()) return {};
    return block_steps_[k];
  }

  /// Adds a step of the velocity, of which every interval has the noise of its part.
  void AddVelocityStep(const VelocityStep& step) {
    velocity_steps_.push_back(step);
  }
  const std::vector<VelocityStep>& velocity_steps() const {
    return velocity_steps_;
  }
  /// What these add from one time to another, as it is at the latter
  /// (VelocityStep::Within).
  VelocityStep::Noise VelocityNoise(double from, double to) const;

  /// Gives a sensor another noise or loss from here on.
  void SetSensor(std::size_t i, const Sensor& sensor) { sensors_[i] = sensor; }
  /// Whether any sensor has a gate.
  bool HasGates() const;
  /// Multiplies the standard deviations of all measurements of a sensor.
  void ScaleSensor(int sensor, double factor);

  /// The context in which measurement z of node k, one of measurements(k), is
  /// evaluated at state x.
  ModelContext Context(std::size_t k, const Measurement& z,
                       const ErrorLayout& layout, const State& x) const {
    return {layout,
            x,
            nodes_[k].kinematics,
            sensors_[static_cast<std::size_t>(z.sensor)],
            z.sensor,
            z.t,
            OffsetRate(z)};
  }

 private:
  using Summaries = std::vector<std::shared_ptr<const ImuSummary>>;
  /// Summaries that are being integrated, of the intervals from `first` on.
  struct Ahead {
    std::size_t first = 0;
    std::shared_future<Summaries> summaries;
  };

  void TakeAhead(std::size_t k);
  void GoAhead(std::size_t k, const ImuCalibration& calibration);
  const RowVector* OffsetRate(const Measurement& z) const {
    if (offset_rates_.measurements.empty()) return nullptr;
    return &offset_rates_.measurements[static_cast<std::size_t>(
        &z - measurements_.data())];
  }

  std::vector<Node> nodes_;
  std::vector<Measurement> measurements_;
  std::vector<Sensor> sensors_;
  std::vector<IncrementStart> increment_starts_;
  TimeOffsetRates offset_rates_;
  double sample_interval_;  // of the IMU [s]
  ImuIntegrator integrator_;
  Summaries summaries_;
  Ahead ahead_;
  std::vector<std::vector<BlockStep>> block_steps_;
  std::vector<VelocityStep> velocity_steps_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_TIMELINE_TIMELINE_H_
