#ifndef HINDSIGHT_IO_READ_TRIPLE_READINGS_H_
#define HINDSIGHT_IO_READ_TRIPLE_READINGS_H_

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "base/units.h"
#include "io/read/file_columns.h"

namespace hindsight {

/// Columns x, y, z of a file.
using ColumnTriple = std::array<int, 3>;

/// Rows over which a reading is called quiet, and over which gravity turns.
inline constexpr std::size_t kReadingWindow = 30;

/// The vectors in three columns of a file, of at most its first 300 000 rows. The
/// file must outlive it.
class TripleReadings {
 public:
  TripleReadings(const FileColumns& file, const ColumnTriple& columns);
  std::size_t rows() const { return rows_; }
  Eigen::Vector3d at(std::size_t row) const {
    return {(*values_[0])[row], (*values_[1])[row], (*values_[2])[row]};
  }

 private:
  std::array<const std::vector<double>*, 3> values_{};
  std::size_t rows_ = 0;
};

/// How gravity is written.
struct GravityUnit {
  const char* name;
  double gravity;  ///< in it
};
inline constexpr std::array kGravityUnits = {
    GravityUnit{"m/s^2", kStandardGravity}, GravityUnit{"g", 1.0},
    GravityUnit{"mg", 1000.0}};

/// Means and scatter over windows of rows.
struct ReadingWindows {
  std::vector<double> length;   ///< of the mean
  std::vector<double> scatter;  ///< standard deviation of a reading
  double quiet_length = 0.0;    ///< median over the quietest tenth
  double quiet_scatter = 0.0;
  double peak = 0.0;  ///< 99 % of readings are no longer
};
ReadingWindows WindowsOf(const TripleReadings& readings);

/// How the direction of gravity turns, as the accelerometers see it, against
/// what the gyros read over the same rows.
struct GravityTurn {
  double slope = 0.0;        ///< seen turn over gyro reading times row
  double correlation = 0.0;  ///< of the two
};

/// `length`: of gravity, or of another vector that stands still on the Earth, in
/// the file's unit; windows that begin or end with another length are passed over.
GravityTurn TurnOf(const TripleReadings& field, const TripleReadings& gyro,
                   double length);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_TRIPLE_READINGS_H_
