#ifndef HINDSIGHT_IO_READ_IMU_GUESS_H_
#define HINDSIGHT_IO_READ_IMU_GUESS_H_

#include <optional>
#include <string>
#include <vector>

#include "dataset/row_rate.h"
#include "io/read/column_meaning.h"
#include "io/read/file_columns.h"
#include "io/read/stamp_guess.h"
#include "io/read/triple_readings.h"

namespace hindsight {

/// Three columns x, y, z in one unit.
struct TripleGuess {
  ColumnTriple columns = {-1, -1, -1};
  std::string unit;    ///< as `columns` of a configuration takes it
  double scale = 1.0;  ///< applied after the unit
  Certainty certainty = Certainty::kCertain;
  std::string reason;
};

struct ImuGuess {
  TripleGuess accel;
  TripleGuess gyro;
  GravityTurn turn;
  /// Untitled columns of a field that turns as gravity does (UntitledImu).
  std::optional<ColumnTriple> field;
  double quiet = 0.0;  ///< what the accelerometers read where quiet [m/s^2]
  std::optional<RowRate> rate;  ///< of a file whose rows are counted
};

/// Accelerometers are three columns whose length, where they are quiet, is that
/// of gravity; gyros are three that turn its direction:
///   f(k + n) - f(k) = -(sum of w dt) x f.
/// Titles are taken at their word; without them FindUntitledImu tells. Where no title says the unit, accelerometers have that of m/s^2, g
/// and mg in which gravity is nearest to 9.81 m/s^2, else counts are scaled to
/// it; gyros the one of rad/s and deg/s that fits the slope, or else the one
/// that fits their size. `row_seconds`: from one row to the next, 0 if not known.
/// Nothing if there are no accelerometers and gyros.
std::optional<ImuGuess> GuessImu(const FileColumns& file,
                                 const std::vector<ColumnMeaning>& meanings,
                                 int stamp_column, double row_seconds);

/// Whether the accelerometers read gravity where quiet, within a fifth of it.
bool FeelsGravity(const ImuGuess& guess);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_IMU_GUESS_H_
