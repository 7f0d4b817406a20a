#include "io/read/fix_motion.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/median.h"
#include "base/units.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

using Values = std::vector<double>;

bool IsSpeed(const Values& v, const FixMotion& motion, double unit) {
  constexpr double kMoving = 1.0;
  Values misfit;
  for (std::size_t k = 0; k < motion.row.size(); ++k) {
    const double value = v[motion.row[k]];
    if (value < 0.0) return false;
    if (motion.speed[k] > kMoving) {
      misfit.push_back(std::abs(value * unit / motion.speed[k] - 1.0));
    }
  }
  return misfit.size() > 10 && Median(misfit) < 0.15;
}

/// The unit in which a column is the speed of the positions; "" if in none.
std::string SpeedUnit(const Values& v, const FixMotion& motion) {
  for (const char* unit : {"m/s", "km/h", "kn"}) {
    if (IsSpeed(v, motion, *UnitFactor(unit, Quantity::kSpeed))) return unit;
  }
  return "";
}

bool IsCourse(const Values& v, const FixMotion& motion, double radians) {
  constexpr double kMoving = 2.0;
  Values misfit;
  for (std::size_t k = 0; k < motion.row.size(); ++k) {
    if (motion.speed[k] < kMoving) continue;
    misfit.push_back(std::abs(std::remainder(
        v[motion.row[k]] * radians - motion.course[k], 2.0 * kPi)));
  }
  return misfit.size() > 10 && Median(misfit) < 10.0 * kDegree;
}

}  // namespace

FixMotion MotionOf(const Values& lat, const Values& lon, const Values& t,
                   FixGuess* guess) {
  constexpr double kRadius = 6.371e6;
  FixMotion motion;
  std::size_t last = 0;
  std::size_t repeated = 0;
  for (std::size_t i = 1; i < lat.size(); ++i) {
    if (lat[i] == lat[i - 1] && lon[i] == lon[i - 1]) {
      ++repeated;
      continue;
    }
    const double dt = t[i] - t[last];
    const double north = (lat[i] - lat[last]) * kRadius;
    const double east = (lon[i] - lon[last]) * kRadius * std::cos(lat[i]);
    last = i;
    if (dt <= 0.0) continue;
    motion.speed.push_back(std::hypot(north, east) / dt);
    motion.course.push_back(std::atan2(east, north));
    motion.row.push_back(i);
  }
  guess->repeated = static_cast<double>(repeated) /
                    static_cast<double>(std::max<std::size_t>(1, lat.size()));
  if (!motion.speed.empty()) {
    Values speeds = motion.speed;
    const auto at = static_cast<std::ptrdiff_t>(speeds.size() * 99 / 100);
    std::nth_element(speeds.begin(), speeds.begin() + at, speeds.end());
    guess->top_speed = *(speeds.begin() + at);
  }
  return motion;
}

void FindSpeedAndCourse(const FileColumns& file,
                        const std::vector<ColumnMeaning>& meanings,
                        const FixMotion& motion, FixGuess* guess) {
  for (std::size_t i = 0; i < file.columns.size(); ++i) {
    const int column = static_cast<int>(i);
    const ColumnMeaning& meaning = meanings[i];
    const Values& v = file.columns[i].values;
    const bool free = meaning.quantity.empty() && column != guess->h.column &&
                      column != guess->lat.column &&
                      column != guess->lon.column;
    const std::string unit = guess->speed ? "" : SpeedUnit(v, motion);
    if (!unit.empty() && (meaning.quantity == "speed" || free)) {
      guess->speed = ColumnGuess{column, unit, 1.0, Certainty::kCertain,
                                 "as fast as the positions move"};
    } else if (!guess->course && (meaning.quantity == "course" || free)) {
      for (const auto& [unit, radians] :
           {std::pair("deg", kDegree), std::pair("rad", 1.0)}) {
        if (guess->course || !IsCourse(v, motion, radians)) continue;
        guess->course = ColumnGuess{column, unit, 1.0, Certainty::kCertain,
                                    "the direction in which they move"};
      }
    }
  }
}

}  // namespace hindsight
