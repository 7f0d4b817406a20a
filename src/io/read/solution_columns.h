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
  std::string name;
  std::string unit;  ///< as written
  double si;         ///< one such unit in SI
  /// Decimals in a text file if positive, significant digits if negative; 0:
  /// as many as give back the value.
  int digits;
  /// What a reader may convert another unit to; absent: no other is accepted.
  std::optional<Quantity> quantity;

  std::string Heading() const { return name + "[" + unit + "]"; }
};

/// The columns of a group, in the order of GroupValues.
const std::vector<SolutionColumn>& Columns(ColumnGroup group);

/// t, of every file of rows in time.
const SolutionColumn& TimeColumn();
/// Distance of forward and backward positions, of two-filter smoothers.
const SolutionColumn& SeparationColumn();
/// Its components (FilterSeparation): differences, then standard deviations.
const std::vector<SolutionColumn>& SeparationColumns();
/// q_nb: w, x, y, z; of attitude alone.
const std::vector<SolutionColumn>& QuaternionColumns();
/// R of the accelerometer in force as a standard deviation, of attitude alone.
const SolutionColumn& AccelSigmaColumn();
/// Whether the magnetometer was used, of attitude alone.
const SolutionColumn& MagneticColumn();
/// w_ib_b and f_b (io/write/motion_csv.h).
const std::vector<SolutionColumn>& MotionColumns();

/// "lat[deg]" of "lat": the title of the column of that name, of all above;
/// the name itself of any other.
std::string HeadingOf(const std::string& name);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_SOLUTION_COLUMNS_H_
