#include "dataset/stamp_check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "base/median.h"

namespace hindsight {
namespace {

/// The stamps of a stream, read where they lie: of a day's IMU a copy is 0.1 GB.
template <typename StampOf>
class Stamps {
 public:
  Stamps(std::size_t count, StampOf stamp) : count_(count), stamp_(stamp) {}

  std::size_t intervals() const { return count_ - 1; }
  double At(std::size_t k) const { return stamp_(k); }
  /// From stamp k to the next.
  double Interval(std::size_t k) const { return At(k + 1) - At(k); }

  double MedianInterval() const {
    std::vector<double> all(intervals());
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = Interval(k);
    return Median(std::move(all));
  }

 private:
  std::size_t count_;
  StampOf stamp_;
};

/// Scatter of intervals about their median, without gaps; a row between two regular
/// ones splits an interval, which late stamps do not.
class Delay {
 public:
  Delay(double median, double longest) : median_(median), longest_(longest) {}

  /// In their order; `next` is infinite behind the last.
  void Add(double interval, double next) {
    if (std::exchange(is_rest_of_split_, false) || interval > longest_) return;
    const double slack = kMaxJitter * median_;
    double excess = interval - median_;
    if (excess < -slack && std::abs(excess + next) <= slack) {
      excess += next;
      is_rest_of_split_ = true;
    }
    squares_ += excess * excess;
    ++count_;
  }
  double value() const {
    return count_ == 0 ? 0.0
                       : std::sqrt(squares_ / static_cast<double>(count_));
  }

 private:
  double median_;
  double longest_;
  bool is_rest_of_split_ = false;
  double squares_ = 0.0;
  long count_ = 0;
};

/// What is longer is a gap [s].
double LongestRegular(double median) { return std::max(3.0 * median, 0.1); }

template <typename StampOf>
StreamReport Report(const std::string& name, std::size_t count, StampOf stamp,
                    const ImuStream& imu) {
  StreamReport report;
  report.name = name;
  report.count = static_cast<long>(count);
  if (count == 0) return report;
  report.t_begin = stamp(0);
  report.t_end = stamp(count - 1);
  report.overlap = std::max(0.0, std::min(report.t_end, imu.t_end()) -
                                     std::max(report.t_begin, imu.t_begin()));
  if (count < 2) return report;
  const Stamps<StampOf> stamps(count, stamp);
  const double median = stamps.MedianInterval();
  if (median > 0.0) report.rate = 1.0 / median;
  const double longest = LongestRegular(median);
  Delay delay(median, longest);
  double squares = 0.0;
  long regular = 0;
  double next = stamps.Interval(0);
  for (std::size_t i = 0; i < stamps.intervals(); ++i) {
    const double interval =
        std::exchange(next, i + 1 < stamps.intervals()
                                ? stamps.Interval(i + 1)
                                : std::numeric_limits<double>::infinity());
    delay.Add(interval, next);
    if (interval == 0.0) ++report.duplicates;
    if (interval > longest) {
      report.gaps.push_back({stamps.At(i), interval});
    } else {
      const double excess = interval - median;
      squares += excess * excess;
      ++regular;
    }
  }
  if (regular > 0) {
    report.jitter = std::sqrt(squares / static_cast<double>(regular));
    report.delay = delay.value();
  }
  return report;
}

/// By how often each interval comes; nothing where the order of the intervals
/// matters: some are gaps, or shorter than late stamps make them.
std::optional<StreamReport> ReportRegular(
    const std::vector<IntervalCount>& intervals) {
  long all = 0;
  for (const IntervalCount& each : intervals) all += each.count;
  if (all == 0) return std::nullopt;
  long before = 0;
  auto middle = intervals.begin();
  while (before + middle->count <= all / 2) before += (middle++)->count;
  const double median = middle->interval;
  if (median <= 0.0 ||
      intervals.front().interval - median < -kMaxJitter * median ||
      intervals.back().interval > LongestRegular(median)) {
    return std::nullopt;
  }
  double squares = 0.0;
  for (const IntervalCount& each : intervals) {
    const double excess = each.interval - median;
    squares += static_cast<double>(each.count) * excess * excess;
  }
  StreamReport report;
  report.name = "imu";
  report.rate = 1.0 / median;
  report.jitter = report.delay = std::sqrt(squares / static_cast<double>(all));
  return report;
}

}  // namespace

StreamReport ReportStamps(const std::string& name,
                          const std::vector<double>& stamps,
                          const ImuStream& imu) {
  return Report(
      name, stamps.size(), [&stamps](std::size_t k) { return stamps[k]; }, imu);
}

StreamReport ReportImuStamps(const ImuStream& imu) {
  const std::size_t first = imu.kind == ImuStream::Kind::kIncrements ? 1 : 0;
  const std::size_t count = imu.samples.size() - first;
  if (const auto facts = FactsOf(imu); facts->intervals) {
    if (auto report = ReportRegular(*facts->intervals)) {
      report->t_begin = imu.samples[first].t;
      report->t_end = imu.t_end();
      report->count = static_cast<long>(count);
      report->overlap = report->t_end - report->t_begin;
      return *std::move(report);
    }
  }
  return Report(
      "imu", count,
      [&imu, first](std::size_t k) { return imu.samples[first + k].t; }, imu);
}

}  // namespace hindsight
