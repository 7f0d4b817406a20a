#include "evaluation/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>

namespace hindsight {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Percentiles of values that are put in order only as far as they need, which is a
/// fraction of sorting them.
class AscendingPercentiles {
 public:
  explicit AscendingPercentiles(std::vector<double> values)
      : values_(std::move(values)) {}

  /// Value below which `fraction` lies, no less than that of the call before:
  /// linear between the order statistics (rank = fraction (n - 1), from 0).
  double At(double fraction) {
    const double rank = fraction * static_cast<double>(values_.size() - 1);
    const auto whole = static_cast<std::ptrdiff_t>(rank);
    const auto below = values_.begin() + whole;
    std::nth_element(values_.begin() + placed_, below, values_.end());
    placed_ = whole;
    const auto above = std::min_element(below + 1, values_.end());
    const double u = rank - static_cast<double>(whole);
    return (1.0 - u) * *below + u * (above == values_.end() ? *below : *above);
  }
  double Max() const {
    return *std::max_element(values_.begin() + placed_, values_.end());
  }

 private:
  std::vector<double> values_;
  std::ptrdiff_t placed_ = 0;  ///< all before it are no larger than it
};

}  // namespace

double Sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

double Last(const std::vector<double>& values) {
  return values.empty() ? kNone : values.back();
}

double Mean(const std::vector<double>& values) {
  if (values.empty()) return kNone;
  return Sum(values) / static_cast<double>(values.size());
}

double Rms(const std::vector<double>& values) {
  if (values.empty()) return kNone;
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double StandardDeviation(const std::vector<double>& values) {
  if (values.empty()) return kNone;
  const double mean = Mean(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum /
                   std::max(1.0, static_cast<double>(values.size()) - 1.0));
}

double Largest(const std::vector<double>& values) {
  if (values.empty()) return kNone;
  return *std::max_element(values.begin(), values.end());
}

double Least(const std::vector<double>& values) {
  if (values.empty()) return kNone;
  return *std::min_element(values.begin(), values.end());
}

double Rank(std::vector<double> values, double fraction) {
  if (values.empty()) return kNone;
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(
      std::ceil(fraction * static_cast<double>(values.size())));
  return values[std::max<std::size_t>(rank, 1) - 1];
}

double Rank50(const std::vector<double>& values) { return Rank(values, 0.50); }
double Rank68(const std::vector<double>& values) { return Rank(values, 0.68); }
double Rank95(const std::vector<double>& values) { return Rank(values, 0.95); }

ErrorStatistics ComputeStatistics(const std::vector<double>& errors) {
  ErrorStatistics s;
  s.count = errors.size();
  const auto n = static_cast<double>(errors.size());
  std::vector<double> magnitudes;
  magnitudes.reserve(errors.size());
  double sum = 0.0;
  double sum2 = 0.0;
  for (const double e : errors) {
    sum += e;
    sum2 += e * e;
    magnitudes.push_back(std::abs(e));
  }
  s.mean = sum / n;
  s.rms = std::sqrt(sum2 / n);
  // A second pass: sum2/n - mean^2 cancels when a bias dominates.
  double scatter = 0.0;
  for (const double e : errors) scatter += (e - s.mean) * (e - s.mean);
  s.std = std::sqrt(scatter / n);
  AscendingPercentiles percentiles(std::move(magnitudes));
  s.p50 = percentiles.At(0.50);
  s.p68 = percentiles.At(0.68);
  s.p95 = percentiles.At(0.95);
  s.p99 = percentiles.At(0.99);
  s.max = percentiles.Max();
  return s;
}

}  // namespace hindsight
