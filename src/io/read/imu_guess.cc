#include "io/read/imu_guess.h"

#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "io/read/column_steps.h"
#include "io/read/units.h"
#include "io/read/untitled_imu.h"

namespace hindsight {
namespace {

std::optional<ColumnTriple> TitledTriple(
    const std::vector<ColumnMeaning>& meanings, const std::string& family) {
  ColumnTriple triple = {-1, -1, -1};
  for (std::size_t i = 0; i < meanings.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (meanings[i].quantity == family + "xyz"[axis]) {
        triple[axis] = static_cast<int>(i);
      }
    }
  }
  if (*std::min_element(triple.begin(), triple.end()) < 0) return std::nullopt;
  return triple;
}

void GuessAccelUnit(const ReadingWindows& windows, const std::string& titled,
                    TripleGuess* accel) {
  const double length = windows.quiet_length;
  if (const auto factor = UnitFactor(titled, Quantity::kAcceleration)) {
    accel->unit = titled;
    accel->reason = fmt::format("unit by its title; {:.2f} m/s^2 where quiet",
                                length * *factor);
    return;
  }
  const GravityUnit* nearest = &kGravityUnits[0];
  for (const GravityUnit& unit : kGravityUnits) {
    if (std::abs(std::log(length / unit.gravity)) <
        std::abs(std::log(length / nearest->gravity))) {
      nearest = &unit;
    }
  }
  accel->unit = nearest->name;
  accel->reason = fmt::format("gravity reads {:.4g} where quiet", length);
  constexpr double kTolerance = 0.2;
  if (std::abs(length / nearest->gravity - 1.0) < kTolerance) return;
  accel->unit = "m/s^2";
  accel->scale = kStandardGravity / length;
  accel->certainty = Certainty::kLikely;
  accel->reason += ": counts, scaled so that it is 9.80665 m/s^2";
}

/// Of gyros in whole numbers beside accelerometers in counts: the range whose
/// counts a deg/s fit how gravity turns, else the smallest, a device's default
/// (32768 counts over 250 to 2000 deg/s; MPU-6050, ICM-20602, LSM6DS).
void GuessGyroCounts(const GravityTurn& turn, double row_seconds,
                     TripleGuess* gyro) {
  constexpr double kShown = 0.5;
  constexpr std::array kRanges = {250.0, 500.0, 1000.0, 2000.0};
  gyro->unit = "deg/s";
  gyro->certainty = Certainty::kGuess;
  double range = kRanges.front();
  gyro->reason = "counts, taken for a range of 250 deg/s";
  if (row_seconds > 0.0 && std::abs(turn.correlation) > kShown) {
    const double seen = std::abs(turn.slope) / row_seconds / kDegree * 32768.0;
    range = *std::min_element(
        kRanges.begin(), kRanges.end(), [&](double a, double b) {
          return std::abs(std::log(a / seen)) < std::abs(std::log(b / seen));
        });
    gyro->certainty = Certainty::kLikely;
    gyro->reason = fmt::format(
        "counts; gravity turns as a range of {:.0f} deg/s says, of {:g} "
        "deg/s",
        seen, range);
  }
  gyro->scale = range / 32768.0;
}

/// Which of rad/s and deg/s, by what gravity turns or by size. Who turns at
/// several rad/s is thrown about by more than g; who is not, turns by several
/// deg/s; and who moves at all turns by more than one.
void GuessGyroUnit(const ReadingWindows& forces, const ReadingWindows& windows,
                   const GravityTurn& turn, double row_seconds,
                   TripleGuess* gyro) {
  constexpr double kShown = 0.5;
  const double slope = std::abs(turn.slope) / row_seconds;
  if (row_seconds > 0.0 && std::abs(turn.correlation) > kShown) {
    for (const auto& [unit, factor] :
         {std::pair("rad/s", 1.0), std::pair("deg/s", kDegree)}) {
      if (std::abs(std::log(slope / factor)) > std::log(2.0)) continue;
      gyro->unit = unit;
      gyro->reason =
          fmt::format("gravity turns {:.3g} times as far as they say in {}",
                      slope / factor, unit);
      return;
    }
  }
  gyro->certainty = Certainty::kLikely;
  constexpr double kFastest = 20.0;  // rad/s
  constexpr double kThrown = 3.0;    // rad/s
  constexpr double kAtRest = 0.02;   // of gravity
  constexpr double kNoisy = 0.01;    // rad/s, of a sensor at rest
  const double shaken = forces.peak / forces.quiet_length - 1.0;
  bool degrees = windows.peak > kFastest;
  if (!degrees && windows.peak > kThrown) degrees = shaken < 1.0;
  if (windows.peak <= kThrown && shaken < kAtRest) {
    degrees = windows.quiet_scatter > kNoisy;
  }
  gyro->unit = degrees ? "deg/s" : "rad/s";
  gyro->reason = fmt::format(
      "up to {:.3g} while shaken by {:.2g} g; gravity turns too little to tell",
      windows.peak, shaken);
}

/// Of counted rows: their rate, and whether the gyros have the sign that it
/// takes; who is thrown about shows no gravity, and its turn says nothing.
void GuessRate(const TripleReadings& accel, const TripleReadings& gyro,
               double gravity, ImuGuess* guess) {
  const auto factor = UnitFactor(guess->gyro.unit, Quantity::kAngularRate);
  if (!factor) return;
  std::vector<Eigen::Vector3d> f;
  std::vector<Eigen::Vector3d> w;
  for (std::size_t k = 0; k < accel.rows(); ++k) {
    f.emplace_back(accel.at(k) / gravity);
    w.emplace_back(*factor * gyro.at(k));
    if (!f.back().allFinite() || !w.back().allFinite()) return;
  }
  const auto as_read = FindRowRate(f, w);
  for (Eigen::Vector3d& rate : w) rate = -rate;
  const auto reversed = FindRowRate(f, w);
  if (as_read && reversed) return;
  guess->rate = as_read ? as_read : reversed;
  if (as_read) guess->turn = {};
}

}  // namespace

std::optional<ImuGuess> GuessImu(const FileColumns& file,
                                 const std::vector<ColumnMeaning>& meanings,
                                 int stamp_column, double row_seconds) {
  if (file.rows < 4 * kReadingWindow) return std::nullopt;
  ImuGuess guess;
  const auto accel = TitledTriple(meanings, "accel_");
  const auto gyro = TitledTriple(meanings, "gyro_");
  if (accel.has_value() != gyro.has_value()) return std::nullopt;
  if (accel) {
    guess.accel.columns = *accel;
    guess.gyro.columns = *gyro;
    const TripleReadings f(file, *accel);
    guess.turn =
        TurnOf(f, TripleReadings(file, *gyro), WindowsOf(f).quiet_length);
  } else {
    const auto found = FindUntitledImu(file, meanings, stamp_column);
    if (!found) return std::nullopt;
    guess.accel.columns = found->accel;
    guess.gyro.columns = found->gyro;
    guess.field = found->field;
    guess.turn = found->turn;
  }
  const auto titled = [&](const TripleGuess& triple) {
    return meanings[static_cast<std::size_t>(triple.columns[0])].unit;
  };
  const ReadingWindows forces =
      WindowsOf(TripleReadings(file, guess.accel.columns));
  const ReadingWindows rates =
      WindowsOf(TripleReadings(file, guess.gyro.columns));
  if (forces.length.empty() || forces.quiet_length <= 0.0) return std::nullopt;
  GuessAccelUnit(forces, titled(guess.accel), &guess.accel);
  guess.quiet = forces.quiet_length * guess.accel.scale *
                UnitFactor(guess.accel.unit, Quantity::kAcceleration).value();
  if (UnitFactor(titled(guess.gyro), Quantity::kAngularRate)) {
    guess.gyro.unit = titled(guess.gyro);
    guess.gyro.reason = "unit by its title";
  } else if (guess.accel.scale != 1.0 &&
             std::all_of(
                 guess.gyro.columns.begin(), guess.gyro.columns.end(),
                 [&](int column) {
                   return AreWholeNumbers(
                       file.columns[static_cast<std::size_t>(column)].values);
                 })) {
    GuessGyroCounts(guess.turn, row_seconds, &guess.gyro);
  } else {
    GuessGyroUnit(forces, rates, guess.turn, row_seconds, &guess.gyro);
  }
  if (row_seconds <= 0.0) {
    GuessRate(TripleReadings(file, guess.accel.columns),
              TripleReadings(file, guess.gyro.columns), forces.quiet_length,
              &guess);
  }
  return guess;
}

bool FeelsGravity(const ImuGuess& guess) {
  constexpr double kTolerance = 0.2;
  return std::abs(guess.quiet / kStandardGravity - 1.0) < kTolerance;
}

}  // namespace hindsight
