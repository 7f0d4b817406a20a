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

/// Requires at least one error. Percentiles are linear between the order statistics
/// (rank = fraction (n - 1), from 0).
ErrorStatistics ComputeStatistics(const std::vector<double>& errors);

/// Statistics of values that may be infinite; NaN of no values.
double Mean(const std::vector<double>& values);
double Rms(const std::vector<double>& values);
/// Standard deviation about the mean, divisor n - 1; zero of a single value.
double StandardDeviation(const std::vector<double>& values);
double Largest(const std::vector<double>& values);
double Least(const std::vector<double>& values);
/// Value below which `fraction` of the values lie, by nearest rank, so that
/// infinite ones stay infinite.
double Rank(std::vector<double> values, double fraction);
double Rank50(const std::vector<double>& values);
double Rank68(const std::vector<double>& values);
double Rank95(const std::vector<double>& values);
double Sum(const std::vector<double>& values);
double Last(const std::vector<double>& values);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_STATISTICS_H_
