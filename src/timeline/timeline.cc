#include "timeline/timeline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "base/parallel.h"

namespace hindsight {
namespace {

/// The usual sample interval, of simulated streams their mean one [s].
double SampleInterval(const ImuStream& imu) {
  if (imu.nominal_dt > 0.0 || imu.empty()) return imu.nominal_dt;
  return (imu.t_end() - imu.t_begin()) /
         static_cast<double>(imu.samples.size() - 1);
}

}  // namespace

Timeline::Timeline(std::vector<Node> nodes,
                   std::vector<Measurement> measurements,
                   std::vector<Sensor> sensors, const ImuStream& imu,
                   bool with_scale_jacobians)
    : nodes_(std::move(nodes)),
      measurements_(std::move(measurements)),
      sensors_(std::move(sensors)),
      sample_interval_(SampleInterval(imu)),
      integrator_(imu, with_scale_jacobians),
      summaries_(nodes_.empty() ? 0 : nodes_.size() - 1) {
  for (Node& node : nodes_) node.kinematics = integrator_.ReadingAt(node.t);
}

const IncrementStart* Timeline::IncrementStartAt(std::size_t k,
                                                 int sensor) const {
  const int node = static_cast<int>(k);
  auto it = std::lower_bound(
      increment_starts_.begin(), increment_starts_.end(), node,
      [](const IncrementStart& start, int n) { return start.node < n; });
  for (; it != increment_starts_.end() && it->node == node; ++it) {
    if (it->sensor == sensor) return &*it;
  }
  return nullptr;
}

namespace {

/// Intervals that are integrated at once beside.
constexpr std::size_t kIntervalsAhead = 64;
/// While the first intervals tell the biases they move too far for that.
constexpr std::size_t kNotAhead = 1024;
/// Pairs of intervals that are worth a thread.
constexpr std::size_t kPairsOfThread = 8;

using SharedSummary = std::shared_ptr<const ImuSummary>;

/// Between `times`, two at once: which two does not depend on the threads.
std::vector<SharedSummary> SummariesBetween(const std::vector<double>& times,
                                            const ImuCalibration& calibration,
                                            const ImuIntegrator& integrator) {
  std::vector<SharedSummary> summaries(times.size() - 1);
  const auto share = [](const ImuSummary& summary) {
    return std::make_shared<const ImuSummary>(summary);
  };
  ForRanges((summaries.size() + 1) / 2, kPairsOfThread,
            [&](std::size_t begin, std::size_t end) {
              ImuIntegrator own = integrator;
              for (std::size_t i = 2 * begin; i < 2 * end; i += 2) {
                if (i + 1 == summaries.size()) {
                  summaries[i] =
                      share(own.Summarize(times[i], times[i + 1], calibration));
                  break;
                }
                const auto pair = own.SummarizePair(
                    {times[i], times[i + 1], times[i + 2]}, calibration);
                summaries[i] = share(pair[0]);
                summaries[i + 1] = share(pair[1]);
              }
            });
  return summaries;
}

}  // namespace

/// What is ready of the intervals about k takes its place.
void Timeline::TakeAhead(std::size_t k) {
  if (!ahead_.summaries.valid() ||
      k / kIntervalsAhead != ahead_.first / kIntervalsAhead) {
    return;
  }
  const Summaries& ready = ahead_.summaries.get();
  for (std::size_t i = 0; i < ready.size(); ++i) {
    std::shared_ptr<const ImuSummary>& present = summaries_[ahead_.first + i];
    if (present == nullptr) present = ready[i];
  }
  ahead_.summaries = {};
}

/// Begins with the intervals behind those about k.
void Timeline::GoAhead(std::size_t k, const ImuCalibration& calibration) {
  const std::size_t first = (k / kIntervalsAhead + 1) * kIntervalsAhead;
  const std::size_t end = std::min(first + kIntervalsAhead, summaries_.size());
  if (k < kNotAhead || first >= end || summaries_[first] != nullptr ||
      (ahead_.summaries.valid() && ahead_.first == first)) {
    return;
  }
  std::vector<double> times;
  for (std::size_t i = first; i <= end; ++i) times.push_back(nodes_[i].t);
  ahead_.first = first;
  ahead_.summaries = InBackground([integrator = integrator_,
                                   times = std::move(times), calibration] {
                       return SummariesBetween(times, calibration, integrator);
                     }).share();
}

const ImuSummary& Timeline::Integrate(std::size_t k,
                                      const ImuCalibration& calibration) {
  std::shared_ptr<const ImuSummary>& present = summaries_[k];
  if (present == nullptr) {
    TakeAhead(k);
    GoAhead(k, calibration);
  }
  if (present == nullptr || NeedsReintegration(*present, calibration)) {
    present = std::make_shared<const ImuSummary>(
        integrator_.Summarize(nodes_[k].t, nodes_[k + 1].t, calibration));
  }
  return *present;
}

namespace {

/// What the IMU reads on average in each third of a window about t, of 50 ms or of
/// six samples where that is more. The rate of a prediction stands for the motion
/// over the whole uncertainty of a time offset; the noise and vibration of a
/// single reading are no part of that.
std::array<Kinematics, 3> ReadAround(double t, double sample_interval,
                                     ImuIntegrator* integrator) {
  constexpr int kPoints = 4;  // a third
  const double step = std::max(0.05, 6.0 * sample_interval) / (3.0 * kPoints);
  std::array<Kinematics, 3> thirds;
  for (int i = 0; i < 3 * kPoints; ++i) {
    const Kinematics k =
        integrator->ReadingAt(t + (i + 0.5 - 1.5 * kPoints) * step);
    Kinematics& third = thirds[static_cast<std::size_t>(i / kPoints)];
    third.w_ib_b += k.w_ib_b / kPoints;
    third.f_b += k.f_b / kPoints;
  }
  return thirds;
}

/// Rates of one component of a sensor's predictions, by which its time offset is
/// told.
struct RatesOfComponent {
  std::vector<double*> rates;
  /// Of the thirds of each window, the first less twice the second and the third.
  std::vector<double> differences;
};

/// Takes the rates of a component for zero if as a whole they are not twice as
/// large as the IMU's noise and vibration make them. They would tell of an offset
/// with the sigma of a motion that never was: on a steady way a DVL of 2 mm/s and
/// the IMU of a phone 7 ms in place of nothing. Of three means of variance s^2 the
/// mean has s^2 / 3 and the second difference, which no jerk enters, 6 s^2; its
/// size is taken from the median.
void DropRatesOfNoise(RatesOfComponent* of) {
  constexpr double kNoise = 2.0;
  constexpr double kMedianOfNormal = 0.6745;
  double sum = 0.0;
  for (const double* rate : of->rates) sum += *rate * *rate;
  std::vector<double> sizes = of->differences;
  for (double& size : sizes) size = std::abs(size);
  const auto middle = sizes.begin() + static_cast<long>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  const double noise = *middle / kMedianOfNormal / std::sqrt(18.0);
  const double rms = std::sqrt(sum / static_cast<double>(of->rates.size()));
  if (rms >= kNoise * noise) return;
  for (double* rate : of->rates) *rate = 0.0;
}

}  // namespace

void Timeline::LinearizeTimeOffsets(const ErrorLayout& layout,
                                    std::span<const State> states) {
  TimeOffsetRates rates;
  rates.measurements.resize(measurements_.size());
  std::map<std::pair<int, int>, RatesOfComponent> components;
  for (std::size_t k = 0; k < size(); ++k) {
    for (const Measurement& z : measurements(k)) {
      if (!layout.Has(BlockKind::kTimeOffset, z.sensor)) continue;
      const std::array<Kinematics, 3> thirds =
          ReadAround(nodes_[k].t, sample_interval_, &integrator_);
      const auto rate = [&](const Kinematics& reading) {
        return TimeOffsetRate(
            z, {layout, states[k], reading,
                sensors_[static_cast<std::size_t>(z.sensor)], z.sensor, z.t});
      };
      const RowVector first = rate(thirds[0]);
      const RowVector second = rate(thirds[1]);
      const RowVector third = rate(thirds[2]);
      RowVector& kept = rates.measurements[static_cast<std::size_t>(
          &z - measurements_.data())];
      kept = (first + second + third) / 3.0;
      for (int row = 0; row < kept.size(); ++row) {
        RatesOfComponent& of = components[{z.sensor, ComponentOf(z, row)}];
        of.rates.push_back(&kept(row));
        of.differences.push_back(first(row) - 2.0 * second(row) + third(row));
      }
    }
  }
  for (auto& [component, of] : components) DropRatesOfNoise(&of);
  for (const IncrementStart& start : increment_starts_) {
    std::optional<double>& rate = rates.increment_starts.emplace_back();
    if (!layout.Has(BlockKind::kTimeOffset, start.sensor)) continue;
    const auto k = static_cast<std::size_t>(start.node);
    rate = PredictedSpeed({layout, states[k], nodes_[k].kinematics,
                           sensors_[static_cast<std::size_t>(start.sensor)],
                           start.sensor, start.stamp});
  }
  SetTimeOffsetRates(std::move(rates));
}

void Timeline::SetTimeOffsetRates(TimeOffsetRates rates) {
  offset_rates_ = std::move(rates);
  for (std::size_t i = 0; i < increment_starts_.size(); ++i) {
    increment_starts_[i].offset_rate = offset_rates_.increment_starts[i];
  }
}

VelocityStep::Noise Timeline::VelocityNoise(double from, double to) const {
  VelocityStep::Noise sum;
  for (const VelocityStep& step : velocity_steps_) {
    const VelocityStep::Noise one = step.Within(from, to);
    sum.pp += one.pp;
    sum.pv += one.pv;
    sum.vv += one.vv;
  }
  return sum;
}

void Timeline::ScaleSensor(int sensor, double factor) {
  for (Measurement& z : measurements_) {
    if (z.sensor == sensor) ScaleSigma(factor, &z);
  }
}

bool Timeline::HasGates() const {
  return std::any_of(
      sensors_.begin(), sensors_.end(),
      [](const Sensor& sensor) { return sensor.gate_probability.has_value(); });
}

}  // namespace hindsight
