#include "io/read/split_seconds.h"

#include <algorithm>
#include <array>

#include "io/read/column_steps.h"
#include "io/read/title_words.h"
#include "io/read/written_dates.h"

namespace hindsight {
namespace {

struct RestUnit {
  const char* name;
  double seconds;
};
constexpr std::array kRestUnits = {RestUnit{"ns", 1e-9}, RestUnit{"us", 1e-6},
                                   RestUnit{"ms", 1e-3}};

bool CountsUpwards(const FileColumn& column) {
  return column.holds == FileColumn::Holds::kNumbers &&
         AreWholeNumbers(column.values) &&
         std::all_of(column.values.begin(), column.values.end(),
                     [](double v) { return v >= 0.0 && v < 1e10; });
}

bool IsNamed(const std::string& title, const RestUnit& unit) {
  const std::vector<std::string> words = SplitWords(title);
  if (unit.seconds == 1e-9) {
    return HasAnyWord(words, {"nanosec", "nsec", "nsecs", "nanoseconds"});
  }
  return unit.seconds == 1e-6 &&
         HasAnyWord(words, {"usec", "usecs", "microsec"});
}

/// Whether a second's last rest comes near to its end.
bool Fills(const FileColumn& whole, double part) {
  return MostlyStand(whole.values) && part > 0.5;
}

}  // namespace

std::optional<SplitSeconds> FindSplitSeconds(const FileColumns& file) {
  constexpr std::size_t kFewest = 4;
  if (file.rows < kFewest) return std::nullopt;
  for (std::size_t i = 0; i + 1 < file.columns.size(); ++i) {
    const FileColumn& whole = file.columns[i];
    const FileColumn& rest = file.columns[i + 1];
    if (!CountsUpwards(whole) || !CountsUpwards(rest)) continue;
    const double largest =
        *std::max_element(rest.values.begin(), rest.values.end());
    if (largest <= 0.0 || !Grows(whole.values, StepsOf(whole.values))) continue;
    for (const RestUnit& unit : kRestUnits) {
      const double part = largest * unit.seconds;
      if (part >= 1.0 || !(Fills(whole, part) || IsNamed(rest.title, unit))) {
        continue;
      }
      SplitSeconds found{static_cast<int>(i), unit.name, whole.values};
      for (std::size_t k = 0; k < found.t.size(); ++k) {
        found.t[k] += unit.seconds * rest.values[k];
      }
      const Steps steps = StepsOf(found.t);
      if (Grows(found.t, steps) && IsSteady(found.t, steps)) return found;
    }
  }
  return std::nullopt;
}

}  // namespace hindsight
