#include "io/read/stamp_guess.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "io/read/column_steps.h"
#include "io/read/counted_rows.h"
#include "io/read/stamp_columns.h"
#include "io/read/text_format.h"
#include "io/read/time_scale.h"
#include "io/read/title_words.h"
#include "io/read/units.h"

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

bool IsUnixTime(double seconds) {
  constexpr double kYear2001 = 978307200.0;
  constexpr double kYear2050 = 2524608000.0;
  return seconds > kYear2001 && seconds < kYear2050;
}

StampGuess GuessOf(const StampColumns& found, const FileColumns& file) {
  StampGuess guess;
  guess.column = found.column;
  if (found.dates) Tell(*found.dates, file, &guess);
  if (found.split) {
    guess.rest_column = found.column + 1;
    guess.rest_unit = found.split->rest_unit;
  }
  return guess;
}

void SetSteps(const std::vector<double>& t, const Steps& steps, double factor,
              StampGuess* guess) {
  guess->first = t.front() * factor;
  guess->step = steps.median * factor;
  guess->gap = steps.longest * factor;
  guess->span = (t.back() - t.front()) * factor;
}

/// False of what are no days of this century.
bool TakeDays(const std::vector<double>& t, const Steps& steps,
              const StampHints& hints, StampGuess* guess) {
  const std::string days = DayCountOf(t.front(), steps.median, hints);
  if (days.empty()) return false;
  SetSteps(t, steps, kDay, guess);
  guess->first = (t.front() - *FirstDayOf(days)) * kDay;
  guess->unit = days;
  guess->scale = StampGuess::Scale::kDate;
  guess->certainty = Certainty::kLikely;
  guess->reason = "days of this century, taken for UTC";
  return true;
}

/// Seconds of the stamps' unit, by the title or else by the rate of the rows;
/// nothing if no unit brings a likely one.
std::optional<double> TakeUnit(const StampColumns& found,
                               const std::string& titled,
                               const std::vector<double>& t, const Steps& steps,
                               const FileColumns& file, const StampHints& hints,
                               StampGuess* guess) {
  if (found.split) {
    guess->reason = "whole seconds, and the next column what is left of them";
    return 1.0;
  }
  if (const auto known = UnitFactor(titled, Quantity::kTime)) {
    guess->unit = titled;
    guess->reason = "by its title";
    return known;
  }
  const std::string& title =
      file.columns[static_cast<std::size_t>(found.column)].title;
  const TimeUnit* unit =
      UnitOfSteps(steps.median, t.back() - t.front(), title, hints);
  if (unit == nullptr) return std::nullopt;
  guess->unit = unit->name;
  guess->certainty = Certainty::kLikely;
  guess->reason =
      fmt::format("steps of {:g}, which are {:.4g} rows a second", steps.median,
                  1.0 / (steps.median * unit->seconds));
  return unit->seconds;
}

}  // namespace

const char* CertaintyName(Certainty certainty) {
  constexpr std::array kNames = {"certain", "likely", "a guess"};
  return kNames[static_cast<std::size_t>(certainty)];
}

std::optional<StampGuess> GuessStamps(
    const FileColumns& file, const std::vector<ColumnMeaning>& meanings,
    const StampHints& hints) {
  const StampColumns found = FindStampColumns(file, meanings);
  if (found.column < 0) return CountedRows(file.rows, hints);
  StampGuess guess = GuessOf(found, file);
  const bool dated = found.dates.has_value();
  std::vector<double> t = TimesIn(found, file);
  if (!dated && HasWeek(meanings)) GoOnOverWeeks(&t);
  const Steps steps = StepsOf(t);
  guess.repeated = steps.repeated;
  guess.unordered = steps.unordered;
  const std::string& unit =
      meanings[static_cast<std::size_t>(found.column)].unit;
  if (MostlyStand(t) && (dated || IsUnixTime(t.front()) ||
                         UnitFactor(unit, Quantity::kTime) == 1.0)) {
    if (!RecogniseWholeSeconds(t, &guess)) return CountedRows(file.rows, hints);
    if (!dated && IsUnixTime(t.front())) guess.scale = StampGuess::Scale::kUnix;
    return guess;
  }
  if (dated) {
    SetSteps(t, steps, 1.0, &guess);
    return guess;
  }
  if (TakeDays(t, steps, hints, &guess)) return guess;
  const auto factor = TakeUnit(found, unit, t, steps, file, hints, &guess);
  if (!factor) return CountedRows(file.rows, hints);
  SetSteps(t, steps, *factor, &guess);
  if (IsUnixTime(guess.first)) guess.scale = StampGuess::Scale::kUnix;
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
