#ifndef HINDSIGHT_IO_READ_STAMP_GUESS_H_
#define HINDSIGHT_IO_READ_STAMP_GUESS_H_

#include <optional>
#include <string>
#include <vector>

#include "io/read/column_meaning.h"
#include "io/read/file_columns.h"

namespace hindsight {

/// How sure a guess is.
enum class Certainty {
  kCertain,  ///< the file says so, or nothing else is possible
  kLikely,   ///< the data speak for it
  kGuess     ///< usual, and not shown by the data
};

/// "certain", "likely", "a guess".
const char* CertaintyName(Certainty certainty);

/// How the rows of a file become times.
struct StampGuess {
  /// What they count from; dates are in the scale that `unit` says.
  enum class Scale { kOwn, kUnix, kDate, kWeek };
  int column = -1;       ///< of the stamps; -1: there is none
  int date_column = -1;  ///< where `column` holds times of day
  int rest_column = -1;  ///< of the second, where `column` holds whole ones
  std::string rest_unit = {};
  /// Of the column; of dates UTC or GPST, of times of day kTimeOfDayUnit.
  std::string unit = "s";
  std::optional<double> rate;  ///< times are row numbers over this [Hz]
  bool starts = false;         ///< and begin at `first`
  Scale scale = Scale::kOwn;
  int week = 0;            ///< of kWeek: GPS week of the first row
  double first = 0.0;      ///< [s]; of dates and weeks since 1970
  double step = 0.0;       ///< the median one [s]
  double span = 0.0;       ///< last minus first [s]
  double gap = 0.0;        ///< the longest step [s]
  bool unordered = false;  ///< some stamps run backwards
  bool repeated = false;   ///< some stand twice
  Certainty certainty = Certainty::kCertain;
  std::string reason;  ///< one clause
};

/// What is known beforehand.
struct StampHints {
  double slowest = 15.0;  ///< rows a second
  double fastest = 4000.0;
  /// Of the IMU's record [s]: of several units the one that brings the file
  /// nearest to it is taken.
  std::optional<double> span;
  /// Rows are counted at this rate where they are counted, not stamped [Hz].
  std::optional<double> count_rate;
  bool rate_stated = false;  ///< by the file itself
};

/// Stamps are a column that grows: dates (of days and times of day their sum),
/// UTC where they say neither zone nor GPST, unless most repeat the one before;
/// days as MATLAB and spreadsheets count them; whole seconds with what is left of
/// them in the next column;
/// else one whose title says so, else times of day, else the first of those. Its unit is the title's, or the only one of s, ms, us, ns in which the
/// rows come at a likely rate. Equal steps of D/(N - 1), where N/D is a whole
/// number of rows a second, are an evenly drawn axis whose last stamp stands a
/// row too late: rows are then counted at N/D. Stamps that span a power of ten
/// times the IMU's record are counted likewise; of whole seconds that several rows
/// share they are counted from where the first second must have begun. Nothing if no column grows and
/// no rate is known.
std::optional<StampGuess> GuessStamps(
    const FileColumns& file, const std::vector<ColumnMeaning>& meanings,
    const StampHints& hints);

/// The times of all rows by that guess [s].
std::vector<double> TimesOf(const FileColumns& file, const StampGuess& stamps);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_STAMP_GUESS_H_
