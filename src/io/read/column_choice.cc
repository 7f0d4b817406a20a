#include "io/read/column_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "io/read/column_steps.h"
#include "io/read/title_words.h"

namespace hindsight {
namespace {

/// Rows with a value other than that of the row before.
std::size_t ChangesOf(const std::vector<double>& values) {
  std::size_t changes = 0;
  for (std::size_t k = 1; k < values.size(); ++k) {
    if (std::isfinite(values[k]) && values[k] != values[k - 1]) ++changes;
  }
  return changes;
}

/// Of columns of one quantity keeps the one of the highest rank, of equal ones the
/// first.
template <typename RankOf>
void KeepBest(const FileColumns& file, std::string_view quantity,
              RankOf rank_of, std::vector<ColumnMeaning>* meanings) {
  ColumnMeaning* kept = nullptr;
  decltype(rank_of(file.columns[0])) best{};
  for (std::size_t i = 0; i < meanings->size(); ++i) {
    ColumnMeaning& meaning = (*meanings)[i];
    if (meaning.quantity != quantity) continue;
    const auto rank = rank_of(file.columns[i]);
    if (kept != nullptr && rank <= best) {
      meaning = {};
      continue;
    }
    if (kept != nullptr) *kept = {};
    kept = &meaning;
    best = rank;
  }
}

/// How likely a column that is titled as a time is the rows' own: it changes from
/// row to row most often; a message's own stamp rather than that of its arrival;
/// what counts samples, and times of day, only if there is no other.
std::pair<std::size_t, int> RankOfTime(const FileColumn& column) {
  const std::vector<std::string> words = SplitWords(column.title);
  const bool own =
      HasAnyWord(words, {"header"}) && HasAnyWord(words, {"stamp"});
  const bool counts =
      HasAnyWord(words, {"sample"}) && !HasAnyWord(words, {"time", "times"});
  const bool of_day = column.holds == FileColumn::Holds::kTimesOfDay;
  return {counts || of_day ? 0 : ChangesOf(column.values), own ? 1 : 0};
}

bool SaysEllipsoid(const std::vector<std::string>& words) {
  return HasAnyWord(words, {"ellipsoid", "ellipsoidal", "ell", "hae", "wgs"});
}
bool SaysSea(const std::vector<std::string>& words) {
  return HasAnyWord(words, {"msl", "amsl", "sea"});
}

/// How likely a place or height is a receiver's own, by the words of its title:
/// neither another estimate nor a place to go to, and above the ellipsoid rather
/// than above the sea or the ground.
int RankOfPlace(const FileColumn& column) {
  const std::vector<std::string> words = SplitWords(column.title);
  int rank = 0;
  if (HasAnyWord(words, {"gps", "gnss", "fix", "receiver"})) rank += 2;
  if (HasAnyWord(words,
                 {"ekf", "kf", "fused", "filter", "filtered", "estimate",
                  "estimated", "est", "home", "ref", "reference", "target",
                  "wp", "waypoint", "setpoint", "network", "origin"})) {
    rank -= 8;
  }
  if (HasAnyWord(words, {"baro", "barometer", "barometric", "press", "pressure",
                         "rel", "relative", "agl", "terrain", "ground"})) {
    rank -= 8;
  }
  if (SaysEllipsoid(words)) rank += 4;
  if (SaysSea(words)) rank -= 1;
  if (ChangesOf(column.values) == 0) rank -= 16;
  return rank;
}

struct UbxField {
  std::string_view title;
  std::string_view unit;
};

/// Columns by the names that u-blox gives the fields of NAV-PVT are in its units
/// where they hold whole numbers and the titles say nothing else.
void TakeUbxUnits(const FileColumns& file,
                  std::vector<ColumnMeaning>* meanings) {
  static constexpr std::array kFields = {
      UbxField{"iTOW", "ms"},     UbxField{"height", "mm"},
      UbxField{"hMSL", "mm"},     UbxField{"hAcc", "mm"},
      UbxField{"vAcc", "mm"},     UbxField{"velN", "mm/s"},
      UbxField{"velE", "mm/s"},   UbxField{"velD", "mm/s"},
      UbxField{"gSpeed", "mm/s"}, UbxField{"sAcc", "mm/s"}};
  constexpr std::size_t kEnough = 4;
  std::vector<std::pair<std::size_t, std::string_view>> units;
  for (std::size_t i = 0; i < meanings->size(); ++i) {
    for (const UbxField& field : kFields) {
      if (file.columns[i].title == field.title &&
          AreWholeNumbers(file.columns[i].values)) {
        units.emplace_back(i, field.unit);
      }
    }
  }
  if (units.size() < kEnough) return;
  for (const auto& [i, unit] : units) {
    if ((*meanings)[i].unit.empty()) (*meanings)[i].unit = unit;
  }
}

/// Four neighbouring columns without titles are a unit quaternion, whose parts may
/// stand in any order, if they are of length one in all rows and turn.
bool AreQuaternion(const FileColumns& file, std::size_t first) {
  constexpr double kRounding = 1e-4;
  constexpr double kTurned = 0.1;
  std::array<double, 4> low{};
  std::array<double, 4> high{};
  for (std::size_t row = 0; row < file.rows; ++row) {
    double squares = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      const double part = file.columns[first + i].values[row];
      squares += part * part;
      low[i] = row == 0 ? part : std::min(low[i], part);
      high[i] = row == 0 ? part : std::max(high[i], part);
    }
    if (!(std::abs(squares - 1.0) < 2.0 * kRounding)) return false;
  }
  double turned = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    turned = std::max(turned, high[i] - low[i]);
  }
  return turned > kTurned;
}

void TakeUntitledQuaternions(const FileColumns& file,
                             std::vector<ColumnMeaning>* meanings) {
  for (std::size_t i = 0; i + 4 <= meanings->size(); ++i) {
    const auto untitled = [&](std::size_t column) {
      return file.columns[column].title.empty() &&
             (*meanings)[column].quantity.empty();
    };
    if (!untitled(i) || !untitled(i + 1) || !untitled(i + 2) ||
        !untitled(i + 3) || !AreQuaternion(file, i)) {
      continue;
    }
    for (std::size_t k = 0; k < 4; ++k) {
      (*meanings)[i + k].quantity = "quaternion";
    }
  }
}

}  // namespace

std::string HalfOfName(const std::string& name) {
  const std::vector<std::string> words = SplitWords(name);
  const bool gyros = HasAnyWord(words, {"gyro", "gyros", "gyr", "gyroscope"});
  const bool accels = HasAnyWord(
      words, {"acc", "acce", "accel", "accelerometer", "acceleration"});
  if (gyros == accels) return "";
  return gyros ? "gyro_" : "accel_";
}

bool CountsFromSea(const FileColumns& file, int h) {
  const std::vector<std::string> words =
      SplitWords(file.columns[static_cast<std::size_t>(h)].title);
  if (SaysEllipsoid(words)) return false;
  return SaysSea(words) ||
         std::any_of(file.columns.begin(), file.columns.end(),
                     [](const FileColumn& column) {
                       return HasAnyWord(SplitWords(column.title),
                                         {"undulation", "geoid"});
                     });
}

std::vector<ColumnMeaning> ReadMeanings(const FileColumns& file) {
  std::vector<ColumnMeaning> meanings;
  std::set<std::string> taken;
  for (const FileColumn& column : file.columns) {
    ColumnMeaning meaning = MeaningOfColumn(column, *file.format);
    constexpr std::array<std::string_view, 4> kRanked = {"t", "lat", "lon",
                                                         "h"};
    const bool ranked = std::find(kRanked.begin(), kRanked.end(),
                                  meaning.quantity) != kRanked.end();
    if (!meaning.quantity.empty() && !ranked &&
        !taken.insert(meaning.quantity).second) {
      meaning = {};
    }
    meanings.push_back(std::move(meaning));
  }
  TakeUbxUnits(file, &meanings);
  TakeUntitledQuaternions(file, &meanings);
  KeepBest(file, "t", RankOfTime, &meanings);
  for (const char* quantity : {"lat", "lon", "h"}) {
    KeepBest(file, quantity, RankOfPlace, &meanings);
  }
  return meanings;
}

}  // namespace hindsight
