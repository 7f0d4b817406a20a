#include "evaluation/statistics.h"

#include <algorithm>
#include <cmath>

namespace hindsight {

double Percentile(const std::vector<double>& sorted, double fraction) {
  const double rank = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  const double u = rank - static_cast<double>(below);
  return (1.0 - u) * sorted[below] + u * sorted[above];
}

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
  std::sort(magnitudes.begin(), magnitudes.end());
  s.p50 = Percentile(magnitudes, 0.50);
  s.p68 = Percentile(magnitudes, 0.68);
  s.p95 = Percentile(magnitudes, 0.95);
  s.p99 = Percentile(magnitudes, 0.99);
  s.max = magnitudes.back();
  return s;
}

}  // namespace hindsight
