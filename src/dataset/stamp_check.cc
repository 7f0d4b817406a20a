#include "dataset/stamp_check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/median.h"

namespace hindsight {
namespace {

/// Scatter of the intervals about their median, without gaps; a row between
/// two regular ones splits an interval, which late stamps do not.
double DelayOf(const std::vector<double>& intervals, double median,
               double longest) {
  const double slack = kMaxJitter * median;
  double squares = 0.0;
  long count = 0;
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    if (intervals[i] > longest) continue;
    double excess = intervals[i] - median;
    if (excess < -slack && i + 1 < intervals.size() &&
        std::abs(excess + intervals[i + 1]) <= slack) {
      excess += intervals[++i];
    }
    squares += excess * excess;
    ++count;
  }
  return count == 0 ? 0.0 : std::sqrt(squares / static_cast<double>(count));
}

}  // namespace

StreamReport ReportStamps(const std::string& name,
                          const std::vector<double>& stamps,
                          const ImuStream& imu) {
  StreamReport report;
  report.name = name;
  report.count = static_cast<long>(stamps.size());
  if (stamps.empty()) return report;
  report.t_begin = stamps.front();
  report.t_end = stamps.back();
  report.overlap = std::max(0.0, std::min(report.t_end, imu.t_end()) -
                                     std::max(report.t_begin, imu.t_begin()));
  if (stamps.size() < 2) return report;
  std::vector<double> intervals(stamps.size() - 1);
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    intervals[i] = stamps[i + 1] - stamps[i];
  }
  const double median = Median(intervals);
  if (median > 0.0) report.rate = 1.0 / median;
  const double longest = std::max(3.0 * median, 0.1);
  double squares = 0.0;
  long regular = 0;
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    if (intervals[i] == 0.0) ++report.duplicates;
    if (intervals[i] > longest) {
      report.gaps.push_back({stamps[i], intervals[i]});
    } else {
      const double excess = intervals[i] - median;
      squares += excess * excess;
      ++regular;
    }
  }
  if (regular > 0) {
    report.jitter = std::sqrt(squares / static_cast<double>(regular));
    report.delay = DelayOf(intervals, median, longest);
  }
  return report;
}

std::vector<double> ImuStamps(const ImuStream& imu) {
  std::vector<double> stamps;
  stamps.reserve(imu.samples.size());
  for (const ImuSample& sample : imu.samples) stamps.push_back(sample.t);
  if (imu.kind == ImuStream::Kind::kIncrements) stamps.erase(stamps.begin());
  return stamps;
}

}  // namespace hindsight
