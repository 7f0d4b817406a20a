#include "io/read/stamp_guess.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "io/read/column_steps.h"
#include "io/read/counted_rows.h"
#include "io/read/text_format.h"
#include "io/read/time_scale.h"
#include "io/read/title_words.h"
#include "io/read/units.h"
#include "io/read/written_dates.h"

namespace hindsight {
namespace {

constexpr double kDay = 86400.0;

/// Says what the columns of dates are.
void Tell(const Dates& dates, const FileColumns& file, StampGuess* guess) {
  const auto column = [&](int number) -> const FileColumn& {
    return file.columns[static_cast<std::size_t>(number)];
  };
  guess->column = dates.column;
  if (IsOfDay(dates, file)) {
    guess->unit = kTimeOfDayUnit;
    guess->reason = "times of day, with no date beside them";
    return;
  }
  guess->date_column = dates.day_column;
  guess->scale = StampGuess::Scale::kDate;
  guess->unit = "UTC";
  std::vector<std::string> words = SplitWords(column(dates.column).title);
  if (dates.day_column >= 0) {
    for (std::string& word : SplitWords(column(dates.day_column).title)) {
      words.push_back(std::move(word));
    }
  }
  const auto says = [&](const char* word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  if (column(dates.column).zoned) {
    guess->reason = "dates with their zone";
  } else if (says("gpst") || says("gps")) {
    guess->unit = "GPST";
    guess->reason = "dates, whose title says so";
  } else if (says("utc")) {
    guess->reason = "dates, whose title says so";
  } else {
    guess->certainty = Certainty::kLikely;
    guess->reason = "dates, which do not say their zone";
  }
}

/// Seconds of the week start again from zero on Sunday.
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

struct TimeUnit {
  const char* name;
  double seconds;
};
/// SampleTimeFine of an Xsens MTi counts these, that of a DOT microseconds.
constexpr TimeUnit kFineTick = {"0.1 ms", 1e-4};
constexpr std::array kTimeUnits = {TimeUnit{"s", 1.0}, kFineTick,
                                   TimeUnit{"ms", 1e-3}, TimeUnit{"us", 1e-6},
                                   TimeUnit{"ns", 1e-9}};

/// Of the units in which rows come at a likely rate the one that brings the
/// span nearest to the IMU's, else the first; nullptr if none does.
const TimeUnit* UnitOfSteps(double step, double span, const std::string& title,
                            const StampHints& hints) {
  const TimeUnit* best = nullptr;
  double nearest = std::numeric_limits<double>::infinity();
  const bool fine = HasAnyWord(SplitWords(title), {"fine"});
  for (const TimeUnit& unit : kTimeUnits) {
    if (unit.seconds == kFineTick.seconds && !fine) continue;
    const double seconds = step * unit.seconds;
    if (seconds * hints.fastest < 1.0 || seconds * hints.slowest > 1.0) {
      continue;
    }
    const double distance =
        hints.span ? std::abs(std::log(span * unit.seconds / *hints.span))
                   : 0.0;
    if (best != nullptr && distance >= nearest) continue;
    best = &unit;
    nearest = distance;
  }
  return best;
}

/// Days, as MATLAB's datenum and spreadsheets count them, of this century.
std::string DayCountOf(double first, double step, const StampHints& hints) {
  if (step * kDay * hints.fastest < 1.0 || step * kDay * hints.slowest > 1.0) {
    return "";
  }
  constexpr double kFirstDay = 11000.0;  // 2000, since 1970
  constexpr double kLastDay = 30000.0;   // 2052
  for (const char* unit : {"datenum", "excel"}) {
    const double day = first - *FirstDayOf(unit);
    if (day > kFirstDay && day < kLastDay) return unit;
  }
  return "";
}

/// Seconds of the week that another column counts, by their title or on its right.
void RecogniseWeek(const FileColumns& file,
                   const std::vector<ColumnMeaning>& meanings,
                   StampGuess* guess) {
  if (guess->rate || guess->scale != StampGuess::Scale::kOwn ||
      guess->first < 0.0 || guess->first >= kWeekSeconds) {
    return;
  }
  const auto stamps = static_cast<std::size_t>(guess->column);
  const bool of_week = HasAnyWord(SplitWords(file.columns[stamps].title),
                                  {"sow", "tow", "week", "gps", "gpst"});
  for (std::size_t i = 0; i < meanings.size(); ++i) {
    const std::vector<double>& v = file.columns[i].values;
    if (meanings[i].quantity != "week" || (!of_week && i + 1 != stamps) ||
        !std::all_of(v.begin(), v.end(), [&](double week) {
          return week == std::floor(week) && week > 0.0 && week <= kLastWeek &&
                 week - v.front() <= 1.0 && week >= v.front();
        })) {
      continue;
    }
    guess->scale = StampGuess::Scale::kWeek;
    guess->week = static_cast<int>(v.front());
    guess->first += static_cast<double>(
        kGpsEpochUnix + std::int64_t{guess->week} * kWeekSeconds);
    return;
  }
}

struct SplitSeconds {
  int column = 0;
  const TimeUnit* rest = nullptr;  ///< unit of the next column
  std::vector<double> t;
};

/// Whether a title says that its column counts a part of the second.
bool IsNamedRest(const std::string& title, const TimeUnit& unit) {
  const std::vector<std::string> words = SplitWords(title);
  return unit.seconds == 1e-9
             ? HasAnyWord(words, {"nanosec", "nsec", "nsecs", "nanoseconds"})
             : unit.seconds == 1e-6 &&
                   HasAnyWord(words, {"usec", "usecs", "microsec"});
}

/// Whole seconds beside a column of what is left of them, as ROS writes stamps: by
/// its title, or where many rows share a second and the rest fills it.
std::optional<SplitSeconds> FindSplitSeconds(const FileColumns& file) {
  const auto fits = [](const FileColumn& column) {
    return column.holds == FileColumn::Holds::kNumbers &&
           AreWholeNumbers(column.values) &&
           std::all_of(column.values.begin(), column.values.end(),
                       [](double v) { return v >= 0.0 && v < 1e10; });
  };
  for (std::size_t i = 0; i + 1 < file.columns.size() && file.rows > 3; ++i) {
    const FileColumn& whole = file.columns[i];
    const FileColumn& rest = file.columns[i + 1];
    if (!fits(whole) || !fits(rest)) continue;
    const double largest =
        *std::max_element(rest.values.begin(), rest.values.end());
    if (largest <= 0.0 || !Grows(whole.values, StepsOf(whole.values))) continue;
    for (const TimeUnit& unit : kTimeUnits) {
      const double part = largest * unit.seconds;
      const bool fills = MostlyStand(whole.values) && part > 0.5 &&
                         unit.seconds != kFineTick.seconds;
      if (unit.seconds > 2e-3 || part >= 1.0 ||
          !(fills || IsNamedRest(rest.title, unit))) {
        continue;
      }
      SplitSeconds found{static_cast<int>(i), &unit, whole.values};
      for (std::size_t k = 0; k < found.t.size(); ++k) {
        found.t[k] += unit.seconds * rest.values[k];
      }
      const Steps steps = StepsOf(found.t);
      if (Grows(found.t, steps) && IsSteady(found.t, steps)) return found;
    }
  }
  return std::nullopt;
}

}  // namespace

const char* CertaintyName(Certainty certainty) {
  constexpr std::array kNames = {"certain", "likely", "a guess"};
  return kNames[static_cast<std::size_t>(certainty)];
}

std::optional<StampGuess> GuessStamps(
    const FileColumns& file, const std::vector<ColumnMeaning>& meanings,
    const StampHints& hints) {
  StampGuess guess;
  guess.column = FindColumn(file, meanings, true);
  auto dates = FindDates(file, meanings);
  const bool other =
      guess.column >= 0 && !(dates && dates->column == guess.column);
  if (dates && other &&
      ((IsOfDay(*dates, file) && !dates->numbers) || MostlyStand(dates->t))) {
    dates.reset();
  }
  const auto split = dates ? std::nullopt : FindSplitSeconds(file);
  if (dates) {
    Tell(*dates, file, &guess);
  } else if (split) {
    guess.column = split->column;
    guess.rest_column = split->column + 1;
    guess.rest_unit = split->rest->name;
  } else if (guess.column < 0) {
    guess.column = FindColumn(file, meanings, false);
  }
  if (guess.column < 0) return CountedRows(file.rows, hints);
  const auto index = static_cast<std::size_t>(guess.column);
  std::vector<double> t = dates   ? dates->t
                          : split ? split->t
                                  : file.columns[index].values;
  if (!dates && HasWeek(meanings)) GoOnOverWeeks(&t);
  const Steps steps = StepsOf(t);
  guess.repeated = steps.repeated;
  guess.unordered = steps.unordered;
  double factor = 1.0;
  constexpr double kYear2001 = 978307200.0;
  constexpr double kYear2050 = 2524608000.0;
  const auto is_unix = [&](double seconds) {
    return seconds > kYear2001 && seconds < kYear2050;
  };
  const auto known = UnitFactor(meanings[index].unit, Quantity::kTime);
  const std::string days =
      dates ? "" : DayCountOf(t.front(), steps.median, hints);
  if (MostlyStand(t) &&
      (dates || is_unix(t.front()) || known == std::optional(1.0))) {
    if (!RecogniseWholeSeconds(t, &guess)) return CountedRows(file.rows, hints);
    if (!dates && is_unix(t.front())) guess.scale = StampGuess::Scale::kUnix;
    return guess;
  }
  if (!days.empty()) {
    guess.unit = days;
    guess.scale = StampGuess::Scale::kDate;
    guess.first = (t.front() - *FirstDayOf(days)) * kDay;
    guess.step = steps.median * kDay;
    guess.gap = steps.longest * kDay;
    guess.span = (t.back() - t.front()) * kDay;
    guess.certainty = Certainty::kLikely;
    guess.reason = "days of this century, taken for UTC";
    return guess;
  }
  if (split) {
    guess.reason = "whole seconds, and the next column what is left of them";
  } else if (!dates && known) {
    guess.unit = meanings[index].unit;
    factor = *known;
    guess.reason = "by its title";
  } else if (!dates) {
    const TimeUnit* unit = UnitOfSteps(steps.median, t.back() - t.front(),
                                       file.columns[index].title, hints);
    if (unit == nullptr) return CountedRows(file.rows, hints);
    guess.unit = unit->name;
    factor = unit->seconds;
    guess.certainty = Certainty::kLikely;
    guess.reason = fmt::format("steps of {:g}, which are {:.4g} rows a second",
                               steps.median, 1.0 / (steps.median * factor));
  }
  guess.first = t.front() * factor;
  guess.step = steps.median * factor;
  guess.gap = steps.longest * factor;
  guess.span = (t.back() - t.front()) * factor;
  if (dates) return guess;
  if (is_unix(guess.first)) {
    guess.scale = StampGuess::Scale::kUnix;
  }
  RecogniseWeek(file, meanings, &guess);
  RecogniseDrawnAxis(t.size(), steps, &guess);
  RecogniseWrongScale(t.size(), hints, &guess);
  return guess;
}

std::vector<double> TimesOf(const FileColumns& file, const StampGuess& stamps) {
  std::vector<double> t(file.rows);
  const bool counted = stamps.rate || stamps.column < 0;
  const bool dated =
      stamps.scale == StampGuess::Scale::kDate || stamps.unit == kTimeOfDayUnit;
  const auto first_day = FirstDayOf(stamps.unit);
  const double factor = first_day ? kDay
                        : counted || dated
                            ? 1.0
                            : *UnitFactor(stamps.unit, Quantity::kTime);
  const auto value = [&](int column, std::size_t row) {
    return file.columns[static_cast<std::size_t>(column)].values[row];
  };
  for (std::size_t i = 0; i < t.size(); ++i) {
    t[i] = counted
               ? static_cast<double>(i) * stamps.step
               : factor * (value(stamps.column, i) - first_day.value_or(0.0));
    if (stamps.date_column >= 0) t[i] += value(stamps.date_column, i);
    if (stamps.rest_column >= 0) {
      t[i] += *UnitFactor(stamps.rest_unit, Quantity::kTime) *
              value(stamps.rest_column, i);
    }
  }
  if (stamps.scale == StampGuess::Scale::kWeek) GoOnOverWeeks(&t);
  if (stamps.unit == kTimeOfDayUnit) {
    const FileColumn& column =
        file.columns[static_cast<std::size_t>(stamps.column)];
    CountFromMidnight(column.holds == FileColumn::Holds::kNumbers, &t);
  }
  return t;
}

}  // namespace hindsight
