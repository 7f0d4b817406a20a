#ifndef HINDSIGHT_EVALUATION_STATISTICS_H_
#define HINDSIGHT_EVALUATION_STATISTICS_H_

#include <cstddef>
#include <vector>

namespace hindsight {

/// Statistics of a set of errors, in the unit of the errors. Percentiles and
/// max are of the absolute values.
struct ErrorStatistics {
  std::size_t count = 0;
  double mean = 0.0;
  double std = 0.0;  ///< about the mean, divisor count
  double rms = 0.0;
  double p50 = 0.0;
  double p68 = 0.0;
  double p95 = 0.0;
  double p99 = 0.0;
  double max = 0.0;
};

/// Requires at least one error.
ErrorStatistics ComputeStatistics(const std::vector<double>& errors);

/// Value below which `fraction` of `sorted` lies, linear between the order
/// statistics (rank = fraction (n - 1), from 0). `sorted` ascending, not empty.
double Percentile(const std::vector<double>& sorted, double fraction);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_STATISTICS_H_
