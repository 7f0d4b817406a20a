#include "dataset/imu_report.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "imu/sample_search.h"

namespace hindsight {
namespace {

/// Sums over time of what the IMU reads.
struct SpanMean {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  double weight = 0.0;
};

/// Over spans in time order, none overlapping another; none without samples.
std::optional<SpanMean> MeanOver(const ImuStream& imu,
                                 const std::vector<TimeInterval>& spans) {
  const bool increments = imu.kind == ImuStream::Kind::kIncrements;
  SpanMean mean;
  for (const TimeInterval& span : spans) {
    const auto add = [&](const ImuSample& before, const ImuSample& sample) {
      if (sample.t > span.end) return false;
      const double dt = sample.t - before.t;
      const double scale = increments ? 1.0 / dt : 1.0;
      mean.force += dt * Eigen::Vector3d(scale * sample.accel);
      mean.rate += dt * Eigen::Vector3d(scale * sample.gyro);
      mean.weight += dt;
      return true;
    };
    WalkSamples(imu,
                std::max<std::size_t>(1, FirstSampleAfter(imu, span.begin)),
                imu.samples.size(), add);
  }
  if (mean.weight <= 0.0) return std::nullopt;
  mean.force /= mean.weight;
  mean.rate /= mean.weight;
  return mean;
}

std::vector<TimeInterval> AllSpans(const Rest& rest) {
  std::vector<TimeInterval> all = rest.at_rest;
  all.insert(all.end(), rest.moving.begin(), rest.moving.end());
  all.insert(all.end(), rest.undecided.begin(), rest.undecided.end());
  std::sort(all.begin(), all.end(),
            [](const TimeInterval& a, const TimeInterval& b) {
              return a.begin < b.begin;
            });
  return all;
}

}  // namespace

ImuReport ReportImu(const Dataset& dataset, const RestMemo& rests) {
  ImuReport report;
  report.rest = rests.Of(dataset);
  report.record = FactsOf(dataset.imu)->readings;
  if (const auto rest = MeanOver(dataset.imu, report.rest.at_rest)) {
    report.rest_force = rest->force;
    report.rest_rate = rest->rate;
  }
  if (const auto still = MeanOver(dataset.imu, AllSpans(report.rest))) {
    report.still_force = still->force;
  }
  return report;
}

}  // namespace hindsight
