#include "io/read/written_dates.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "io/read/column_steps.h"

namespace hindsight {
namespace {

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

}  // namespace

void CountFromMidnight(bool numbers, std::vector<double>* t) {
  if (numbers) {
    for (double& one : *t) one = SecondsOfClock(one);
  }
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

std::optional<Dates> FindDates(const FileColumns& file,
                               const std::vector<ColumnMeaning>& meanings) {
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
  Dates dates{find(kDates), -1, false, {}};
  if (dates.column >= 0) {
    dates.t = values(dates.column);
  } else {
    dates.column = find(kTimesOfDay);
    dates.day_column = find(kDays);
    if (dates.column < 0) {
      dates.column = FindClocks(file, meanings);
      dates.day_column = -1;
      dates.numbers = dates.column >= 0;
    }
    if (dates.column < 0) return std::nullopt;
    dates.t = values(dates.column);
    for (std::size_t k = 0; dates.day_column >= 0 && k < dates.t.size(); ++k) {
      dates.t[k] += values(dates.day_column)[k];
    }
    if (dates.day_column < 0) CountFromMidnight(dates.numbers, &dates.t);
  }
  if (dates.t.size() < 3 || !Grows(dates.t, StepsOf(dates.t))) {
    return std::nullopt;
  }
  return dates;
}

bool MostlyStand(const std::vector<double>& t) {
  std::size_t moving = 0;
  for (std::size_t k = 1; k < t.size(); ++k) {
    if (t[k] != t[k - 1]) ++moving;
  }
  return 2 * moving < t.size();
}

bool IsOfDay(const Dates& dates, const FileColumns& file) {
  return dates.day_column < 0 &&
         file.columns[static_cast<std::size_t>(dates.column)].holds !=
             FileColumn::Holds::kDates;
}

}  // namespace hindsight
