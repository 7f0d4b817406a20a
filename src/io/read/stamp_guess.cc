#include "io/read/stamp_guess.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/median.h"
#include "io/read/text_format.h"
#include "io/read/title_words.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

/// Shares of rows.
constexpr double kMostlyGrowing = 0.99;
constexpr double kEven = 1e-6;

struct Steps {
  double median = 0.0;  ///< of those above zero
  double longest = 0.0;
  double unevenness = 0.0;  ///< largest distance from it over it
  double growing = 0.0;     ///< share of rows that do not fall behind
  bool repeated = false;
  bool unordered = false;
};

Steps StepsOf(const std::vector<double>& t) {
  Steps steps;
  std::vector<double> positive;
  std::size_t kept = 0;
  for (std::size_t i = 1; i < t.size(); ++i) {
    const double step = t[i] - t[i - 1];
    if (step >= 0.0) ++kept;
    if (step > 0.0) positive.push_back(step);
    steps.repeated = steps.repeated || step == 0.0;
    steps.unordered = steps.unordered || step < 0.0;
  }
  if (t.size() < 2 || positive.empty()) return steps;
  steps.median = Median(positive);
  for (const double step : positive) {
    steps.longest = std::max(steps.longest, step);
    steps.unevenness =
        std::max(steps.unevenness, std::abs(step / steps.median - 1.0));
  }
  steps.growing = static_cast<double>(kept) / static_cast<double>(t.size() - 1);
  return steps;
}

bool Grows(const std::vector<double>& t, const Steps& steps) {
  return steps.growing >= kMostlyGrowing && t.back() > t.front() &&
         std::all_of(t.begin(), t.end(),
                     [](double x) { return std::isfinite(x); });
}

/// A column of times has steps about as long everywhere.
bool IsSteady(const std::vector<double>& t, const Steps& steps) {
  const double mean =
      (t.back() - t.front()) / static_cast<double>(t.size() - 1);
  return steps.median < 3.0 * mean && mean < 10.0 * steps.median;
}

/// Times that are written as dates, or as times of day.
struct Dates {
  int column = -1;
  int day_column = -1;
  std::vector<double> t;
};

/// Times of day that run over midnight go on counting.
void CountDays(std::vector<double>* t) {
  constexpr double kDay = 86400.0;
  double midnight = 0.0;
  for (std::size_t k = 1; k < t->size(); ++k) {
    (*t)[k] += midnight;
    if ((*t)[k] < (*t)[k - 1] - 0.5 * kDay) {
      midnight += kDay;
      (*t)[k] += kDay;
    }
  }
}

double SecondsOfClock(double hhmmss) {
  const double hours = std::floor(hhmmss / 1e4);
  const double minutes = std::floor((hhmmss - 1e4 * hours) / 100.0);
  return 3600.0 * hours + 60.0 * minutes +
         (hhmmss - 1e4 * hours - 100.0 * minutes);
}

/// Whether numbers are hhmmss.sss: minutes and seconds below 60 throughout, and
/// even where such a count jumps from 59 to 100.
bool AreClocks(const std::vector<double>& values) {
  bool jumps = false;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double v = values[k];
    const double seconds = std::fmod(v, 100.0);
    const double minutes = std::fmod(std::floor(v / 100.0), 100.0);
    if (!(v >= 0.0) || v >= 240000.0 || seconds >= 61.0 || minutes >= 60.0) {
      return false;
    }
    if (k == 0 || std::abs(v - values[k - 1]) <= 40.0) continue;
    const double step = SecondsOfClock(v) - SecondsOfClock(values[k - 1]);
    jumps = jumps || std::fmod(step + 86400.0, 86400.0) < 20.0;
  }
  return jumps;
}

/// The column that a title calls a time and that holds hhmmss.sss, or -1.
int FindClocks(const FileColumns& file,
               const std::vector<ColumnMeaning>& meanings) {
  for (std::size_t i = 0; i < meanings.size(); ++i) {
    const FileColumn& column = file.columns[i];
    if (meanings[i].quantity == "t" &&
        column.holds == FileColumn::Holds::kNumbers &&
        AreClocks(column.values)) {
      return static_cast<int>(i);
    }
  }
  return -1;
}

/// Those that grow from row to row; nothing if most stand still, as those in
/// whole seconds do.
/// `clocks`: a column of hhmmss.sss, or -1.
std::optional<Dates> FindDates(const FileColumns& file, int clocks) {
  using enum FileColumn::Holds;
  const auto find = [&](FileColumn::Holds holds) {
    const auto at = std::find_if(
        file.columns.begin(), file.columns.end(),
        [&](const FileColumn& column) { return column.holds == holds; });
    return at == file.columns.end()
               ? -1
               : static_cast<int>(at - file.columns.begin());
  };
  const auto values = [&](int column) -> const std::vector<double>& {
    return file.columns[static_cast<std::size_t>(column)].values;
  };
  Dates dates{find(kDates), -1, {}};
  if (dates.column >= 0) {
    dates.t = values(dates.column);
  } else {
    dates.column = find(kTimesOfDay);
    dates.day_column = find(kDays);
    if (dates.column < 0 && clocks >= 0) {
      dates.column = clocks;
      dates.day_column = -1;
    }
    if (dates.column < 0) return std::nullopt;
    dates.t = values(dates.column);
    for (std::size_t k = 0; dates.day_column >= 0 && k < dates.t.size(); ++k) {
      dates.t[k] += values(dates.day_column)[k];
    }
    if (dates.column == clocks) {
      for (double& t : dates.t) t = SecondsOfClock(t);
    }
    if (dates.day_column < 0) CountDays(&dates.t);
  }
  if (dates.t.size() < 3) return std::nullopt;
  std::size_t moving = 0;
  for (std::size_t k = 1; k < dates.t.size(); ++k) {
    if (dates.t[k] != dates.t[k - 1]) ++moving;
  }
  if (2 * moving < dates.t.size() || !Grows(dates.t, StepsOf(dates.t))) {
    return std::nullopt;
  }
  return dates;
}

/// Whether there is no day.
bool IsOfDay(const Dates& dates, const FileColumns& file) {
  return dates.day_column < 0 &&
         file.columns[static_cast<std::size_t>(dates.column)].holds !=
             FileColumn::Holds::kDates;
}

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

/// The first column of numbers that grows: one that a title names, or else one
/// that no title does, what counts rows one by one only if there is no other.
int FindColumn(const FileColumns& file,
               const std::vector<ColumnMeaning>& meanings, bool titled) {
  int counter = -1;
  for (std::size_t i = 0; i < file.columns.size(); ++i) {
    const bool fits =
        (titled ? meanings[i].quantity == "t" : meanings[i].quantity.empty()) &&
        file.columns[i].holds == FileColumn::Holds::kNumbers;
    const auto& t = file.columns[i].values;
    if (!fits || t.size() < 3) continue;
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
constexpr std::array kTimeUnits = {TimeUnit{"s", 1.0}, TimeUnit{"ms", 1e-3},
                                   TimeUnit{"us", 1e-6}, TimeUnit{"ns", 1e-9}};

/// Of the units in which rows come at a likely rate the one that brings the
/// span nearest to the IMU's, else the first; nullptr if none does.
const TimeUnit* UnitOfSteps(double step, double span, const StampHints& hints) {
  const TimeUnit* best = nullptr;
  double nearest = std::numeric_limits<double>::infinity();
  for (const TimeUnit& unit : kTimeUnits) {
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

bool IsWhole(double value, double tolerance) {
  return value > 0.5 && std::abs(value - std::round(value)) < tolerance * value;
}

/// An axis drawn from 0 to D in N points, where N rows of D/N were meant.
void RecogniseDrawnAxis(std::size_t rows, const Steps& steps,
                        StampGuess* guess) {
  if (rows < 50 || steps.unevenness > kEven) return;
  const double rate = static_cast<double>(rows) / guess->span;
  if (!IsWhole(rate, 1e-9) || IsWhole(1.0 / guess->step, 1e-6)) return;
  guess->rate = std::round(rate);
  guess->certainty = Certainty::kLikely;
  guess->reason = fmt::format(
      "the stamps are {} points drawn evenly from 0 to {:g} s: rows are "
      "counted "
      "at {:g} Hz instead, a stretch of {:.3g} %",
      rows, guess->span, *guess->rate, 100.0 / static_cast<double>(rows - 1));
  guess->step = 1.0 / *guess->rate;
  guess->span = static_cast<double>(rows - 1) * guess->step;
}

/// Stamps that tell ten times the time that the IMU recorded.
void RecogniseWrongScale(std::size_t rows, const StampHints& hints,
                         StampGuess* guess) {
  if (!hints.span || guess->rate || guess->scale != StampGuess::Scale::kOwn) {
    return;
  }
  const double ratio = guess->span / *hints.span;
  const double power = std::round(std::log10(ratio));
  if (power == 0.0 || std::abs(std::log10(ratio) - power) > 0.013) return;
  const double seconds = guess->step / std::pow(10.0, power);
  guess->rate = 1.0 / seconds;
  guess->certainty = Certainty::kLikely;
  guess->reason = fmt::format(
      "the stamps span {:.4g} times the record of the IMU: rows are counted at "
      "{:g} Hz instead",
      ratio, *guess->rate);
  guess->step = seconds;
  guess->span = static_cast<double>(rows - 1) * seconds;
  guess->first = 0.0;
}

/// The whole number of rows a second, or of seconds a row, within 5 %; else the
/// rate itself.
double NearWhole(double rate) {
  constexpr double kNear = 0.05;
  const bool slow = rate < 1.0;
  const double whole = std::round(slow ? 1.0 / rate : rate);
  const double nearest = slow ? 1.0 / whole : whole;
  return std::abs(rate / nearest - 1.0) < kNear ? nearest : rate;
}

/// Without stamps: at the IMU's rate, or as long as the IMU recorded where that
/// would be another length.
std::optional<StampGuess> Counted(std::size_t rows, const StampHints& hints) {
  if (!hints.count_rate || rows < 2) return std::nullopt;
  StampGuess guess;
  const double steps = static_cast<double>(rows - 1);
  guess.rate = hints.count_rate;
  std::string as = hints.rate_stated ? "as the file says" : "as the IMU's";
  constexpr double kAsLong = 0.1;
  if (!hints.rate_stated && hints.span && *hints.span > 0.0 &&
      std::abs(steps / (*guess.rate * *hints.span) - 1.0) > kAsLong) {
    guess.rate = NearWhole(steps / *hints.span);
    as = "for a record as long as the IMU's";
  }
  guess.step = 1.0 / *guess.rate;
  guess.span = steps * guess.step;
  if (!hints.rate_stated) guess.certainty = Certainty::kLikely;
  guess.reason =
      fmt::format("rows are counted at {:g} Hz, {}", *guess.rate, as);
  return guess;
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
  const int clocks = FindClocks(file, meanings);
  auto dates = FindDates(file, clocks);
  if (dates && IsOfDay(*dates, file) && guess.column >= 0 && clocks < 0) {
    dates.reset();
  }
  if (dates) {
    Tell(*dates, file, &guess);
  } else if (guess.column < 0) {
    guess.column = FindColumn(file, meanings, false);
  }
  if (guess.column < 0) return Counted(file.rows, hints);
  const auto index = static_cast<std::size_t>(guess.column);
  const std::vector<double>& t = dates ? dates->t : file.columns[index].values;
  const Steps steps = StepsOf(t);
  guess.repeated = steps.repeated;
  guess.unordered = steps.unordered;
  double factor = 1.0;
  const auto known = UnitFactor(meanings[index].unit, Quantity::kTime);
  if (!dates && known && *known <= 1.0) {
    guess.unit = meanings[index].unit;
    factor = *known;
    guess.reason = "by its title";
  } else if (!dates) {
    const TimeUnit* unit =
        UnitOfSteps(steps.median, t.back() - t.front(), hints);
    if (unit == nullptr) return Counted(file.rows, hints);
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
  constexpr double kYear2001 = 978307200.0;
  constexpr double kYear2050 = 2524608000.0;
  if (guess.first > kYear2001 && guess.first < kYear2050) {
    guess.scale = StampGuess::Scale::kUnix;
  }
  RecogniseDrawnAxis(t.size(), steps, &guess);
  RecogniseWrongScale(t.size(), hints, &guess);
  return guess;
}

std::vector<double> TimesOf(const FileColumns& file, const StampGuess& stamps) {
  std::vector<double> t(file.rows);
  const bool counted = stamps.rate || stamps.column < 0;
  const bool dated =
      stamps.scale == StampGuess::Scale::kDate || stamps.unit == kTimeOfDayUnit;
  const double factor =
      counted || dated ? 1.0 : *UnitFactor(stamps.unit, Quantity::kTime);
  const auto value = [&](int column, std::size_t row) {
    return file.columns[static_cast<std::size_t>(column)].values[row];
  };
  for (std::size_t i = 0; i < t.size(); ++i) {
    t[i] = counted ? static_cast<double>(i) * stamps.step
                   : factor * value(stamps.column, i);
    if (stamps.date_column >= 0) t[i] += value(stamps.date_column, i);
  }
  if (stamps.unit == kTimeOfDayUnit) {
    const bool numbers =
        file.columns[static_cast<std::size_t>(stamps.column)].holds ==
        FileColumn::Holds::kNumbers;
    if (numbers) {
      for (double& one : t) one = SecondsOfClock(one);
    }
    CountDays(&t);
  }
  return t;
}

}  // namespace hindsight
