#include "io/read/fix_guess.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "base/median.h"
#include "base/units.h"
#include "io/read/column_steps.h"
#include "io/read/fix_motion.h"
#include "io/read/text_format.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

using Values = std::vector<double>;

const Values& Column(const FileColumns& file, int column) {
  return file.columns[static_cast<std::size_t>(column)].values;
}

int Titled(const std::vector<ColumnMeaning>& meanings,
           const std::string& quantity) {
  for (std::size_t i = 0; i < meanings.size(); ++i) {
    if (meanings[i].quantity == quantity) return static_cast<int>(i);
  }
  return -1;
}

/// Without a meaning by its title, which names no axis either.
bool IsFree(const FileColumns& file, const std::vector<ColumnMeaning>& meanings,
            int column) {
  const auto i = static_cast<std::size_t>(column);
  return meanings[i].quantity.empty() &&
         AxisMeaning(file.columns[i].title, "axis").quantity.empty();
}

double LargestStep(const Values& v) {
  Values steps;
  for (std::size_t i = 1; i < v.size(); ++i) {
    steps.push_back(std::abs(v[i] - v[i - 1]));
  }
  if (steps.empty()) return 0.0;
  const auto at = static_cast<std::ptrdiff_t>(steps.size() * 99 / 100);
  std::nth_element(steps.begin(), steps.begin() + at, steps.end());
  return *(steps.begin() + at);
}

/// An angle on the Earth in degrees that changes as a vehicle moves.
bool LooksLikeAngle(const Values& v, double most) {
  constexpr double kFastest = 0.02;  // of a row to the next, 2 km
  constexpr double kWidest = 10.0;
  const auto [low, high] = std::minmax_element(v.begin(), v.end());
  const bool fine = std::any_of(v.begin(), v.end(), [](double x) {
    const double digits = x * 1e4;
    return std::abs(digits - std::round(digits)) > 1e-5;
  });
  return fine && std::isfinite(*low) && std::isfinite(*high) && *low >= -most &&
         *high <= most && std::abs(*low) > 0.01 && *high > *low &&
         *high - *low < kWidest && LargestStep(v) < kFastest;
}

bool IsHeight(const Values& v) {
  constexpr double kDeepest = -12000.0;
  constexpr double kHighest = 20000.0;
  constexpr double kFastest = 20.0;  // m from row to row
  const auto [low, high] = std::minmax_element(v.begin(), v.end());
  return *low > kDeepest && *high<kHighest&& * high> * low &&
         LargestStep(v) < kFastest;
}

Values Radians(const FileColumns& file, const ColumnGuess& place) {
  const bool minutes = place.unit == kDegreesMinutesUnit;
  const double factor =
      place.sign * *UnitFactor(minutes ? "deg" : place.unit, Quantity::kAngle);
  Values radians = Column(file, place.column);
  for (double& v : radians) v = factor * (minutes ? FromDegreesMinutes(v) : v);
  return radians;
}

bool HoldsNumbers(const FileColumns& file, int column) {
  return file.columns[static_cast<std::size_t>(column)].holds ==
         FileColumn::Holds::kNumbers;
}

bool FindPlaces(const FileColumns& file,
                const std::vector<ColumnMeaning>& meanings, int stamp_column,
                FixGuess* guess) {
  guess->lat.column = Titled(meanings, "lat");
  guess->lon.column = Titled(meanings, "lon");
  guess->h.column = Titled(meanings, "h");
  const auto reason = "by its title";
  guess->lat.reason = guess->lon.reason = guess->h.reason = reason;
  if (guess->lat.column >= 0 && guess->lon.column >= 0) return true;
  const int count = static_cast<int>(file.columns.size());
  for (int i = 0; i + 1 < count; ++i) {
    if (i == stamp_column || i + 1 == stamp_column || !HoldsNumbers(file, i) ||
        !HoldsNumbers(file, i + 1) || !IsFree(file, meanings, i) ||
        !IsFree(file, meanings, i + 1) ||
        !LooksLikeAngle(Column(file, i), 90.0) ||
        !LooksLikeAngle(Column(file, i + 1), 180.0)) {
      continue;
    }
    guess->lat = {i, "deg", 1.0, Certainty::kLikely,
                  "within +-90, changes as a place does"};
    guess->lon = {i + 1, "deg", 1.0, Certainty::kLikely,
                  "within +-180, changes as a place does"};
    return true;
  }
  return false;
}

void FindHeight(const FileColumns& file,
                const std::vector<ColumnMeaning>& meanings, int stamp_column,
                FixGuess* guess) {
  if (guess->h.column >= 0) return;
  for (int i = guess->lon.column + 1; i < static_cast<int>(file.columns.size());
       ++i) {
    const bool taken = (guess->speed && guess->speed->column == i) ||
                       (guess->course && guess->course->column == i);
    if (i == stamp_column || taken || !HoldsNumbers(file, i) ||
        !IsFree(file, meanings, i) || !IsHeight(Column(file, i))) {
      continue;
    }
    guess->h = {i, "m", 1.0, Certainty::kLikely,
                "the next column that changes as a height does"};
    return;
  }
}

/// The unit that a title gives, else the usual one.
void TakeUnit(const std::vector<ColumnMeaning>& meanings, Quantity quantity,
              const char* usual, ColumnGuess* guess) {
  if (guess->column < 0) return;
  const ColumnMeaning& meaning =
      meanings[static_cast<std::size_t>(guess->column)];
  const bool known = UnitFactor(meaning.unit, quantity).has_value();
  guess->unit = known ? meaning.unit : usual;
}

/// Degrees and minutes in one number, as NMEA writes them: too large for degrees, and
/// never 60 minutes.
bool AreDegreesAndMinutes(const Values& lat, const Values& lon) {
  const auto fits = [](const Values& v, double most) {
    return std::all_of(v.begin(), v.end(), [&](double x) {
      return std::abs(x) < 100.0 * most && std::fmod(std::abs(x), 100.0) < 60.0;
    });
  };
  const auto beyond = [](const Values& v, double most) {
    return std::all_of(v.begin(), v.end(),
                       [&](double x) { return std::abs(x) > most; });
  };
  return fits(lat, 90.0) && fits(lon, 180.0) &&
         (beyond(lat, 90.0) || beyond(lon, 180.0));
}

void TakeDegreesAndMinutes(const FileColumns& file, FixGuess* guess) {
  if (!AreDegreesAndMinutes(Column(file, guess->lat.column),
                            Column(file, guess->lon.column))) {
    return;
  }
  for (ColumnGuess* place : {&guess->lat, &guess->lon}) {
    place->unit = kDegreesMinutesUnit;
    place->reason = "degrees times 100 and minutes, as NMEA writes them";
  }
}

/// Letters in the next column turn the sign where all say south or west.
void TakeSide(const FileColumns& file, std::string_view sides,
              ColumnGuess* place) {
  const auto next = static_cast<std::size_t>(place->column) + 1;
  if (next >= file.columns.size()) return;
  const FileColumn& letters = file.columns[next];
  if (letters.holds != FileColumn::Holds::kText ||
      letters.side != sides.back()) {
    return;
  }
  place->sign = -place->sign;
  place->reason += std::string(", and all ") + letters.side;
}

constexpr double kSemicircle = 180.0 / 2147483648.0;  // [deg]

/// Whether the titles are those of FIT, Garmin's format.
bool AreOfFit(const FileColumns& file, const FixGuess& guess) {
  const auto title = [&](const ColumnGuess& place) {
    return file.columns[static_cast<std::size_t>(place.column)].title;
  };
  return title(guess.lat).starts_with("position_lat") &&
         title(guess.lon).starts_with("position_long");
}

/// Receivers write places as whole numbers of 1e-7 deg, and heights beside them
/// in mm (UBX-NAV-PVT, MAVLink's GPS_RAW_INT).
void TakeWholeNumbers(const FileColumns& file,
                      const std::vector<ColumnMeaning>& meanings,
                      FixGuess* guess) {
  constexpr double kLeast = 1e5;  // 0.01 deg
  constexpr double kMost = 2147483648.0;
  for (const ColumnGuess* place : {&guess->lat, &guess->lon}) {
    const Values& v = Column(file, place->column);
    if (!AreWholeNumbers(v) || std::any_of(v.begin(), v.end(), [](double x) {
          return std::abs(x) < kLeast || std::abs(x) > kMost;
        })) {
      return;
    }
  }
  const bool fit = AreOfFit(file, *guess);
  for (ColumnGuess* place : {&guess->lat, &guess->lon}) {
    place->unit = "deg";
    place->sign = fit ? kSemicircle : 1e-7;
    place->reason = fit ? "semicircles, 180 deg / 2^31, by its title"
                        : "whole numbers of 1e-7 deg, as receivers write them";
    place->certainty = Certainty::kLikely;
  }
  if (fit) return;
  if (guess->h.column < 0 || !AreWholeNumbers(Column(file, guess->h.column)) ||
      !meanings[static_cast<std::size_t>(guess->h.column)].unit.empty()) {
    return;
  }
  guess->h.unit = "mm";
  guess->h.reason = "whole numbers, beside places of 1e-7 deg";
  guess->h.certainty = Certainty::kLikely;
}

}  // namespace

std::optional<FixGuess> GuessFixes(const FileColumns& file,
                                   const std::vector<ColumnMeaning>& meanings,
                                   const StampGuess& stamps) {
  FixGuess guess;
  if (!FindPlaces(file, meanings, stamps.column, &guess)) return std::nullopt;
  TakeUnit(meanings, Quantity::kAngle, "deg", &guess.lat);
  TakeUnit(meanings, Quantity::kAngle, "deg", &guess.lon);
  const std::string& unit =
      meanings[static_cast<std::size_t>(guess.lat.column)].unit;
  guess.place_order_told = guess.lat.certainty == Certainty::kCertain;
  guess.place_unit_told = UnitFactor(unit, Quantity::kAngle).has_value();
  const Values t = TimesOf(file, stamps);
  TakeUnit(meanings, Quantity::kLength, "m", &guess.h);
  TakeWholeNumbers(file, meanings, &guess);
  TakeDegreesAndMinutes(file, &guess);
  TakeSide(file, "NS", &guess.lat);
  TakeSide(file, "EW", &guess.lon);
  const Values lat = Radians(file, guess.lat);
  const Values lon = Radians(file, guess.lon);
  guess.place = {Median(lat), Median(lon)};
  const FixMotion motion = MotionOf(lat, lon, t, &guess);
  FindSpeedAndCourse(file, meanings, motion, &guess);
  FindHeight(file, meanings, stamps.column, &guess);
  return guess;
}

}  // namespace hindsight
