#ifndef HINDSIGHT_IO_READ_SOLUTION_COLUMNS_H_
#define HINDSIGHT_IO_READ_SOLUTION_COLUMNS_H_

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "io/read/units.h"

namespace hindsight {

/// The columns of a solution file that only make sense together; see
/// solution_csv.h.
enum class ColumnGroup {
  kPosition,
  kVelocity,
  kAttitude,
  kSdPosition,
  kSdVelocity,
  kSdAttitude,
  kGyroBias,
  kAccelBias,
  kSdGyroBias,
  kSdAccelBias,
  kCovPosition,
  kCovVelocity,
  kCovAttitude,
};
inline constexpr int kColumnGroups = 13;

/// Up to six values of a group at one epoch, in SI units and radians.
using GroupValues = Eigen::Matrix<double, 6, 1>;

struct SolutionColumn {
  const char* name;
  const char* unit;  ///< as written
  double si;         ///< one such unit in SI
  /// Decimals in the file if not negative, significant digits if negative.
  int digits;
  /// What a reader may convert another unit to; absent: no other is accepted.
  std::optional<Quantity> quantity;

  std::string Heading() const { return std::string(name) + "[" + unit + "]"; }
};

/// The columns of a group, in the order of GroupValues.
const std::vector<SolutionColumn>& Columns(ColumnGroup group);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_SOLUTION_COLUMNS_H_
