#ifndef HINDSIGHT_IO_READ_FIX_GUESS_H_
#define HINDSIGHT_IO_READ_FIX_GUESS_H_

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "io/read/column_meaning.h"
#include "io/read/stamp_guess.h"

namespace hindsight {

/// A column and how it is read.
struct ColumnGuess {
  int column = -1;
  std::string unit;
  double sign = 1.0;
  Certainty certainty = Certainty::kCertain;
  std::string reason;
};

/// Where a record was made, to some kilometres [rad].
struct RoughPlace {
  double lat = 0.0;
  double lon = 0.0;
};

/// Columns of latitude, longitude and height, and of speed and course over the
/// ground where these agree with the positions.
struct FixGuess {
  ColumnGuess lat;
  ColumnGuess lon;
  ColumnGuess h;
  std::optional<ColumnGuess> speed;
  std::optional<ColumnGuess> course;
  /// A title tells it.
  bool place_unit_told = false;
  bool place_order_told = false;
  std::optional<RoughPlace> place;
  /// Share of rows whose place is that of the row before.
  double repeated = 0.0;
  double top_speed = 0.0;  ///< of one fix to another, 99 % are slower [m/s]
};

/// By titles; without them two neighbouring columns within +-90 and +-180 that
/// are no whole numbers and change little from row to row, and the height next
/// to them. Degrees, unless the title says radians. Nothing if there are no such
/// columns.
std::optional<FixGuess> GuessFixes(const FileColumns& file,
                                   const std::vector<ColumnMeaning>& meanings,
                                   const StampGuess& stamps);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_FIX_GUESS_H_
