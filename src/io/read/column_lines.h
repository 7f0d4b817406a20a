#ifndef HINDSIGHT_IO_READ_COLUMN_LINES_H_
#define HINDSIGHT_IO_READ_COLUMN_LINES_H_

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/quantity.h"
#include "io/read/column_choice.h"
#include "io/read/column_meaning.h"
#include "io/read/file_columns.h"
#include "io/read/fix_guess.h"
#include "io/read/found_stream.h"

namespace hindsight {

/// Writes the lines by which a configuration reads streams out of columns of
/// numbers, each with the title or the reason by which it was told.
class ColumnLines {
 public:
  explicit ColumnLines(const FileColumns& file)
      : file_(file), meanings_(ReadMeanings(file)) {}

  /// Takes places along axes for velocities (AsVelocity).
  void TakeForVelocities() {
    for (ColumnMeaning& meaning : meanings_) {
      meaning = AsVelocity(std::move(meaning));
    }
  }

  /// Of a DVL's file: takes velocities along axes for those of its own axes.
  void TakeForDvl();
  /// Takes the columns of a triple for the family's, so that they are nothing else.
  void Take(const std::string& family, const TripleGuess& triple);
  /// Takes columns that are titled by an axis alone for a family's (AxisMeaning).
  void TakeAxesFor(const std::string& family);

  /// Whether a vector is as long as the Earth's field, 20 to 70 uT, in a usual unit.
  bool IsOfEarth(const ColumnTriple& columns) const;

  const std::vector<ColumnMeaning>& meanings() const { return meanings_; }
  /// The stamps of all streams; needed before the first.
  const std::optional<StampGuess>& stamps() const { return stamps_; }
  void set_stamps(std::optional<StampGuess> stamps) {
    stamps_ = std::move(stamps);
  }

  /// What the configuration of every stream of the file says.
  FoundStream Stream() const;
  /// The same of an IMU, with the drop-outs that it bridges.
  FoundStream ImuStreamOf(const ImuGuess& guess) const;
  /// Puts a line behind the others of `columns`.
  static void AddLine(KeyLine line, FoundStream* found);
  /// The line of a column there.
  void AddColumn(const std::string& quantity, const ColumnGuess& guess,
                 FoundStream* found) const;
  /// Columns family + "x", "y", "z".
  void AddTriple(const std::string& family, const TripleGuess& triple,
                 FoundStream* found) const;
  /// A titled column of a kind's quantity, in the title's unit; where it states
  /// none in SI, but angles and fields in the unit that their size shows.
  void AddTitledColumn(const std::string& quantity, Quantity dimension,
                       FoundStream* found) const;
  /// Those of `names` that are columns of the kind.
  void AddFieldsOf(const SensorKind& kind,
                   const std::vector<std::string>& names,
                   FoundStream* found) const;

  /// The column that is titled as this quantity, or -1.
  int Titled(const std::string& quantity) const;
  bool HasAll(const std::vector<std::string>& names) const;

 private:
  std::string AngleUnit() const;
  std::string PlaceUnit() const;
  /// A field in the unit of uT, nT, mG and G in which it is nearest to 48 uT.
  struct FieldSize {
    std::string unit = "uT";
    double field = 0.0;  ///< median [uT]
  };
  FieldSize FieldSizeOf(const ColumnTriple& columns) const;

  const FileColumns& file_;
  std::vector<ColumnMeaning> meanings_;
  std::optional<StampGuess> stamps_;
};

/// The line `noise` of positions with slow errors of sigma `slow`, correlated over
/// a minute as those of a receiver on its own usually are, and white ones [m].
KeyLine SlowFixNoise(double slow, double white, const std::string& comment);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_COLUMN_LINES_H_
