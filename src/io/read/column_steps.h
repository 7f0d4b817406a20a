#ifndef HINDSIGHT_IO_READ_COLUMN_STEPS_H_
#define HINDSIGHT_IO_READ_COLUMN_STEPS_H_

#include <vector>

namespace hindsight {

/// How a column goes on from row to row.
struct Steps {
  double median = 0.0;  ///< of those above zero
  double longest = 0.0;
  double unevenness = 0.0;  ///< largest distance from it over it
  double growing = 0.0;     ///< share of rows that do not fall behind
  bool repeated = false;
  bool unordered = false;
};
Steps StepsOf(const std::vector<double>& t);

/// Whether 99 % of its rows do not fall behind the one before, and every value is
/// a number.
bool Grows(const std::vector<double>& t, const Steps& steps);

/// Whether every value that is there is a whole number.
bool AreWholeNumbers(const std::vector<double>& values);

/// A column of times has steps about as long everywhere.
bool IsSteady(const std::vector<double>& t, const Steps& steps);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_COLUMN_STEPS_H_
