#include "io/read/untitled_imu.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/median.h"

namespace hindsight {
namespace {

/// Three neighbouring columns.
struct Neighbours {
  ColumnTriple columns;
  TripleReadings readings;
  ReadingWindows windows;
  double evenness;  ///< smallest noise of an axis over the largest
  double length;    ///< median
};

bool AreApart(const Neighbours& a, const Neighbours& b) {
  return a.columns[0] > b.columns[2] || b.columns[0] > a.columns[2];
}

/// Median over windows of how far a reading is from the line through those on both
/// sides.
double NoiseOf(const std::vector<double>& values, std::size_t rows) {
  std::vector<double> noise;
  for (std::size_t k = 0; k + kReadingWindow <= rows; k += kReadingWindow) {
    double sum = 0.0;
    for (std::size_t i = k + 1; i + 1 < k + kReadingWindow; ++i) {
      sum += std::abs(values[i + 1] - 2.0 * values[i] + values[i - 1]);
    }
    if (std::isfinite(sum)) noise.push_back(sum);
  }
  return noise.empty() ? 0.0 : Median(std::move(noise));
}

/// In which all is a number.
std::vector<Neighbours> FreeNeighbours(
    const FileColumns& file, const std::vector<ColumnMeaning>& meanings,
    int stamp_column) {
  std::vector<double> noise;
  for (const FileColumn& column : file.columns) {
    noise.push_back(NoiseOf(column.values, file.rows));
  }
  std::vector<Neighbours> all;
  for (std::size_t i = 0; i + 2 < file.columns.size(); ++i) {
    bool free = true;
    for (std::size_t j = i; j < i + 3; ++j) {
      free = free && meanings[j].quantity.empty() &&
             static_cast<int>(j) != stamp_column;
    }
    if (!free) continue;
    const int first = static_cast<int>(i);
    const ColumnTriple columns = {first, first + 1, first + 2};
    TripleReadings readings(file, columns);
    ReadingWindows windows = WindowsOf(readings);
    if (windows.length.empty()) continue;
    const auto [least, most] =
        std::minmax({noise[i], noise[i + 1], noise[i + 2]});
    const double length = Median(windows.length);
    all.push_back({columns, readings, std::move(windows),
                   most > 0.0 ? least / most : 0.0, length});
  }
  return all;
}

bool LooksLikeGravity(const ReadingWindows& windows) {
  constexpr double kTolerance = 0.1;
  return std::any_of(
      kGravityUnits.begin(), kGravityUnits.end(), [&](const GravityUnit& unit) {
        return std::abs(windows.quiet_length / unit.gravity - 1.0) < kTolerance;
      });
}

/// How surely a third vector turns with the gyros, 0 to 1; and which.
struct FieldTurn {
  double correlation = 0.0;
  std::optional<ColumnTriple> columns;
};

FieldTurn FieldBeside(const std::vector<Neighbours>& all,
                      const Neighbours& accel, const Neighbours& gyro) {
  constexpr double kShown = 0.5;
  FieldTurn best = {kShown, std::nullopt};
  for (const Neighbours& field : all) {
    if (!AreApart(field, accel) || !AreApart(field, gyro)) continue;
    const double turn =
        TurnOf(field.readings, gyro.readings, field.length).correlation;
    if (turn > best.correlation) best = {turn, field.columns};
  }
  return best.columns ? best : FieldTurn{};
}

}  // namespace

std::optional<UntitledImu> FindUntitledImu(
    const FileColumns& file, const std::vector<ColumnMeaning>& meanings,
    int stamp_column) {
  constexpr double kTurns = 0.3;
  constexpr double kEvenness = 0.25;  // of what a turn of gravity tells
  const std::vector<Neighbours> all =
      FreeNeighbours(file, meanings, stamp_column);
  std::optional<UntitledImu> found;
  double best = 0.0;
  for (const Neighbours& accel : all) {
    if (!LooksLikeGravity(accel.windows)) continue;
    for (const Neighbours& gyro : all) {
      if (!AreApart(accel, gyro)) continue;
      const GravityTurn turn =
          TurnOf(accel.readings, gyro.readings, accel.windows.quiet_length);
      // What stands still has turned nothing; gyros then read next to nothing.
      const bool still = gyro.windows.quiet_length < 0.3 * gyro.windows.peak;
      if (std::abs(turn.correlation) < kTurns && !still) continue;
      const FieldTurn field = FieldBeside(all, accel, gyro);
      const double score = std::abs(turn.correlation) + (still ? 0.1 : 0.0) +
                           field.correlation +
                           kEvenness * (accel.evenness + gyro.evenness);
      if (score <= best) continue;
      best = score;
      found = {accel.columns, gyro.columns, turn, field.columns};
    }
  }
  return found;
}

}  // namespace hindsight
