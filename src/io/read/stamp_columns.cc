#include "io/read/stamp_columns.h"

#include <algorithm>

#include "io/read/column_steps.h"
#include "io/read/time_scale.h"

namespace hindsight {
namespace {

/// The first column of numbers that grows: one that a title names, or else one
/// that no title does, what counts rows one by one only if there is no other.
int FindColumn(const FileColumns& file,
               const std::vector<ColumnMeaning>& meanings, bool titled) {
  int counter = -1;
  for (std::size_t i = 0; i < file.columns.size(); ++i) {
    const bool fits =
        (titled ? meanings[i].quantity == "t" : meanings[i].quantity.empty()) &&
        file.columns[i].holds == FileColumn::Holds::kNumbers;
    if (!fits || file.rows < 3) continue;
    std::vector<double> t = file.columns[i].values;
    if (titled && HasWeek(meanings)) GoOnOverWeeks(&t);
    const Steps steps = StepsOf(t);
    if (!Grows(t, steps) || (!titled && !IsSteady(t, steps))) continue;
    if (titled || steps.median != 1.0 || steps.unevenness > 0.0) {
      return static_cast<int>(i);
    }
    if (counter < 0) counter = static_cast<int>(i);
  }
  return counter;
}

}  // namespace

void GoOnOverWeeks(std::vector<double>* t) {
  double weeks = 0.0;
  for (std::size_t k = 1; k < t->size(); ++k) {
    (*t)[k] += weeks;
    if ((*t)[k] - (*t)[k - 1] >= -0.5 * kWeekSeconds) continue;
    weeks += kWeekSeconds;
    (*t)[k] += kWeekSeconds;
  }
}

bool HasWeek(const std::vector<ColumnMeaning>& meanings) {
  return std::any_of(
      meanings.begin(), meanings.end(),
      [](const ColumnMeaning& m) { return m.quantity == "week"; });
}

StampColumns FindStampColumns(const FileColumns& file,
                              const std::vector<ColumnMeaning>& meanings) {
  StampColumns found;
  found.column = FindColumn(file, meanings, true);
  found.dates = FindDates(file, meanings);
  const bool other = found.column >= 0 &&
                     !(found.dates && found.dates->column == found.column);
  if (found.dates && other &&
      ((IsOfDay(*found.dates, file) && !found.dates->numbers) ||
       MostlyStand(found.dates->t))) {
    found.dates.reset();
  }
  if (found.dates) {
    found.column = found.dates->column;
    return found;
  }
  found.split = FindSplitSeconds(file);
  if (found.split) {
    found.column = found.split->column;
  } else if (found.column < 0) {
    found.column = FindColumn(file, meanings, false);
  }
  return found;
}

const std::vector<double>& TimesIn(const StampColumns& found,
                                   const FileColumns& file) {
  if (found.dates) return found.dates->t;
  if (found.split) return found.split->t;
  return file.columns[static_cast<std::size_t>(found.column)].values;
}

}  // namespace hindsight
