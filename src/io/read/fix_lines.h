#ifndef HINDSIGHT_IO_READ_FIX_LINES_H_
#define HINDSIGHT_IO_READ_FIX_LINES_H_

#include <optional>
#include <string>
#include <vector>

#include "io/read/column_lines.h"
#include "io/read/file_columns.h"
#include "io/read/fix_guess.h"
#include "io/read/found_stream.h"

namespace hindsight {

/// What is assumed of heights that seem to be above the sea.
inline constexpr char kSeaHeights[] =
    "its heights seem to count from the sea; they are taken for heights above "
    "the ellipsoid, which differ by the geoid's, -105 to 85 m";

/// The key `sigma` of that many fixes without a height.
KeyLine SigmaWithoutHeight(double fixes);

/// Writes the lines by which a configuration reads a receiver's positions out of
/// columns of numbers. File and lines must outlive it.
class FixLines {
 public:
  FixLines(const FileColumns& file, const ColumnLines& lines)
      : file_(file), lines_(lines) {}

  /// The rows that hold a place: neither nothing nor zeros, as receivers write
  /// before their first fix. Titles say which columns are latitude and longitude.
  FileColumns RowsWithPlaces() const;

  FoundStream Position(const FixGuess& fixes) const;
  /// Fixes as x, y and z from the Earth's centre; nothing of others.
  std::optional<FoundStream> EarthCentred() const;
  /// Fixes as easting and northing of UTM; nothing of others.
  std::optional<FoundStream> Utm() const;
  /// Of velocities, one of all axes.
  void AddSpeedAccuracy(FoundStream* found) const;
  /// Of places along axes: Earth-centred by its size, else local axes.
  void SetFrame(FoundStream* found) const;

 private:
  /// A height that is known to a kilometre by all fixes together: it is the same
  /// error in each.
  void AddWithoutHeight(const FixGuess& fixes, FoundStream* found) const;
  /// One sigma of all axes, or the accuracies that receivers and phones state.
  void AddAccuracies(FoundStream* found) const;
  /// A column of standard deviations, or -1 where it is none: receivers write
  /// zero or less for what they do not know.
  int StatedSigma(const std::string& quantity) const;
  ColumnGuess SigmaGuess(int column, Quantity dimension, double factor,
                         const std::string& reason) const;
  /// Whether places along axes are as far from their origin as the ground is from
  /// the Earth's centre.
  bool AreEarthCentred() const;
  void AddZone(FoundStream* found) const;
  double MedianOf(int column) const;
  const std::vector<double>& Values(int column) const {
    return file_.columns[static_cast<std::size_t>(column)].values;
  }

  const FileColumns& file_;
  const ColumnLines& lines_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_FIX_LINES_H_
