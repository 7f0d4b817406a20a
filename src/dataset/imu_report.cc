#include "dataset/imu_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace hindsight {
namespace {

/// Means over spans of time, of readings in time order.
class SpanMean {
 public:
  explicit SpanMean(const std::vector<TimeInterval>& spans) : spans_(spans) {}

  void Add(double t, double dt, const Eigen::Vector3d& f,
           const Eigen::Vector3d& w) {
    while (next_ < spans_.size() && spans_[next_].end < t) ++next_;
    if (next_ == spans_.size() || t <= spans_[next_].begin) return;
    force_ += dt * f;
    rate_ += dt * w;
    weight_ += dt;
  }

  std::optional<Eigen::Vector3d> force() const { return Mean(force_); }
  std::optional<Eigen::Vector3d> rate() const { return Mean(rate_); }

 private:
  std::optional<Eigen::Vector3d> Mean(const Eigen::Vector3d& sum) const {
    if (weight_ <= 0.0) return std::nullopt;
    return sum / weight_;
  }

  const std::vector<TimeInterval>& spans_;
  std::size_t next_ = 0;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();
  double weight_ = 0.0;
};

/// The mean of the specific force over the second in which it varies least.
class QuietestSecond {
 public:
  void Add(double dt, const Eigen::Vector3d& f) {
    sum_ += dt * f;
    squares_ += dt * f.squaredNorm();
    duration_ += dt;
    if (duration_ >= 1.0) End();
  }

  /// Of a shorter record, the mean over all of it.
  Eigen::Vector3d mean() const {
    return std::isfinite(least_) ? mean_ : Eigen::Vector3d(sum_ / duration_);
  }

 private:
  void End() {
    const Eigen::Vector3d mean = sum_ / duration_;
    const double variance = squares_ / duration_ - mean.squaredNorm();
    if (variance < least_) {
      least_ = variance;
      mean_ = mean;
    }
    sum_.setZero();
    squares_ = duration_ = 0.0;
  }

  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  double squares_ = 0.0;
  double duration_ = 0.0;
  double least_ = std::numeric_limits<double>::infinity();
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();
};

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

ImuReport ReportImu(const Dataset& dataset) {
  ImuReport report;
  const ImuStream& imu = dataset.imu;
  report.rest = FindRest(dataset);
  const std::vector<TimeInterval> all = AllSpans(report.rest);
  SpanMean rest(report.rest.at_rest);
  SpanMean still(all);
  QuietestSecond quietest;
  double duration = 0.0;
  for (std::size_t k = 1; k < imu.samples.size(); ++k) {
    const ImuSample& sample = imu.samples[k];
    const double dt = sample.t - imu.samples[k - 1].t;
    const double scale =
        imu.kind == ImuStream::Kind::kIncrements ? 1.0 / dt : 1.0;
    const Eigen::Vector3d f = scale * sample.accel;
    const Eigen::Vector3d w = scale * sample.gyro;
    report.mean_force += dt * f.norm();
    report.mean_force_b += dt * f;
    duration += dt;
    report.max_force = std::max(report.max_force, f.norm());
    report.max_rate = std::max(report.max_rate, w.norm());
    quietest.Add(dt, f);
    rest.Add(sample.t, dt, f, w);
    still.Add(sample.t, dt, f, w);
  }
  report.mean_force /= duration;
  report.mean_force_b /= duration;
  report.quietest_force = quietest.mean();
  report.rest_force = rest.force();
  report.rest_rate = rest.rate();
  report.still_force = still.force();
  return report;
}

}  // namespace hindsight
