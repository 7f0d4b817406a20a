#include "io/read/imu_guess.h"

#include <fmt/core.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "base/median.h"
#include "base/units.h"
#include "io/read/column_steps.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

using Triple = std::array<int, 3>;

/// Rows over which a reading is called quiet, and over which gravity turns.
constexpr std::size_t kWindow = 30;
constexpr std::size_t kMostRows = 300'000;

class Readings {
 public:
  Readings(const FileColumns& file, const Triple& columns) {
    for (std::size_t i = 0; i < 3; ++i) {
      values_[i] = &file.columns[static_cast<std::size_t>(columns[i])].values;
    }
    rows_ = std::min(file.rows, kMostRows);
  }
  std::size_t rows() const { return rows_; }
  Eigen::Vector3d at(std::size_t row) const {
    return {(*values_[0])[row], (*values_[1])[row], (*values_[2])[row]};
  }

 private:
  std::array<const std::vector<double>*, 3> values_{};
  std::size_t rows_ = 0;
};

/// Means and scatter over windows of rows.
struct Windows {
  std::vector<double> length;   ///< of the mean
  std::vector<double> scatter;  ///< standard deviation of a reading
  double quiet_length = 0.0;    ///< median over the quietest tenth
  double quiet_scatter = 0.0;
  double peak = 0.0;  ///< 99 % of readings are no longer
};

Windows WindowsOf(const Readings& readings) {
  Windows windows;
  std::vector<double> lengths;
  for (std::size_t k = 0; k + kWindow <= readings.rows(); k += kWindow) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double squares = 0.0;
    for (std::size_t i = k; i < k + kWindow; ++i) {
      const Eigen::Vector3d v = readings.at(i);
      sum += v;
      squares += v.squaredNorm();
      if (v.allFinite()) lengths.push_back(v.norm());
    }
    const Eigen::Vector3d mean = sum / static_cast<double>(kWindow);
    const double variance =
        squares / static_cast<double>(kWindow) - mean.squaredNorm();
    if (!std::isfinite(variance)) continue;
    windows.length.push_back(mean.norm());
    windows.scatter.push_back(std::sqrt(std::max(0.0, variance)));
  }
  if (windows.length.empty()) return windows;
  std::vector<std::size_t> order(windows.length.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return windows.scatter[a] < windows.scatter[b];
  });
  std::vector<double> quiet;
  const std::size_t tenth = std::max<std::size_t>(1, order.size() / 10);
  for (std::size_t i = 0; i < tenth; ++i) {
    quiet.push_back(windows.length[order[i]]);
  }
  windows.quiet_length = Median(quiet);
  windows.quiet_scatter = windows.scatter[order[tenth / 2]];
  const auto at = static_cast<std::ptrdiff_t>(lengths.size() * 99 / 100);
  std::nth_element(lengths.begin(), lengths.begin() + at, lengths.end());
  windows.peak = *(lengths.begin() + at);
  return windows;
}

/// `length`: of gravity in the file's unit; windows that begin or end with
/// another force are passed over.
GravityTurn TurnOf(const Readings& accel, const Readings& gyro, double length) {
  constexpr double kAlike = 0.1;
  double across = 0.0;
  double predicted = 0.0;
  double seen = 0.0;
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < gyro.rows(); ++k) bias += gyro.at(k);
  bias /= static_cast<double>(std::max<std::size_t>(1, gyro.rows()));
  constexpr std::size_t kMean = 5;
  for (std::size_t k = 0; k + kWindow + kMean < accel.rows();
       k += kWindow / 2) {
    Eigen::Vector3d before = Eigen::Vector3d::Zero();
    Eigen::Vector3d behind = Eigen::Vector3d::Zero();
    Eigen::Vector3d turn = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < kMean; ++i) {
      before += accel.at(k + i);
      behind += accel.at(k + kWindow + i);
    }
    for (std::size_t i = 0; i < kWindow; ++i) {
      turn += gyro.at(k + kMean / 2 + i) - bias;
    }
    const Eigen::Vector3d f = (before + behind).normalized();
    const Eigen::Vector3d change = behind.normalized() - before.normalized();
    const Eigen::Vector3d expected = -turn.cross(f);
    if (!change.allFinite() || !expected.allFinite()) continue;
    const double mean = length * static_cast<double>(kMean);
    if (std::abs(before.norm() / mean - 1.0) > kAlike ||
        std::abs(behind.norm() / mean - 1.0) > kAlike) {
      continue;
    }
    across += change.dot(expected);
    predicted += expected.squaredNorm();
    seen += change.squaredNorm();
  }
  if (predicted <= 0.0 || seen <= 0.0) return {};
  return {across / predicted, across / std::sqrt(predicted * seen)};
}

struct GravityUnit {
  const char* name;
  double gravity;  ///< in it
};
constexpr std::array kGravityUnits = {GravityUnit{"m/s^2", kStandardGravity},
                                      GravityUnit{"g", 1.0},
                                      GravityUnit{"mg", 1000.0}};

bool LooksLikeGravity(const Windows& windows, double tolerance) {
  return std::any_of(
      kGravityUnits.begin(), kGravityUnits.end(), [&](const GravityUnit& unit) {
        return std::abs(windows.quiet_length / unit.gravity - 1.0) < tolerance;
      });
}

std::optional<Triple> TitledTriple(const std::vector<ColumnMeaning>& meanings,
                                   const std::string& family) {
  Triple triple = {-1, -1, -1};
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

/// Neighbouring columns that no title names.
std::vector<Triple> UntitledTriples(const FileColumns& file,
                                    const std::vector<ColumnMeaning>& meanings,
                                    int stamp_column) {
  std::vector<Triple> triples;
  for (std::size_t i = 0; i + 2 < file.columns.size(); ++i) {
    bool free = true;
    for (std::size_t j = i; j < i + 3; ++j) {
      free = free && meanings[j].quantity.empty() &&
             static_cast<int>(j) != stamp_column;
    }
    const int first = static_cast<int>(i);
    if (free) triples.push_back({first, first + 1, first + 2});
  }
  return triples;
}

bool Overlap(const Triple& a, const Triple& b) {
  return a[0] <= b[2] && b[0] <= a[2];
}

/// Columns that no title names: the accelerometers whose quiet length is
/// gravity's, with the gyros that turn it best.
bool FindUntitled(const FileColumns& file,
                  const std::vector<ColumnMeaning>& meanings, int stamp_column,
                  ImuGuess* guess) {
  constexpr double kLikeGravity = 0.1;
  constexpr double kTurns = 0.3;
  const auto triples = UntitledTriples(file, meanings, stamp_column);
  double best = 0.0;
  for (const Triple& accel : triples) {
    const Readings f(file, accel);
    const Windows windows = WindowsOf(f);
    if (!LooksLikeGravity(windows, kLikeGravity)) continue;
    for (const Triple& gyro : triples) {
      if (Overlap(accel, gyro)) continue;
      const Readings w(file, gyro);
      const GravityTurn turn = TurnOf(f, w, windows.quiet_length);
      // What stands still has turned nothing; gyros then read next to nothing.
      const Windows rates = WindowsOf(w);
      const bool still = rates.quiet_length < 0.3 * rates.peak;
      const double score = std::abs(turn.correlation) + (still ? 0.1 : 0.0);
      if (score <= best || (std::abs(turn.correlation) < kTurns && !still)) {
        continue;
      }
      best = score;
      guess->accel.columns = accel;
      guess->gyro.columns = gyro;
      guess->turn = turn;
    }
  }
  return best > 0.0;
}

void GuessAccelUnit(const Windows& windows, const std::string& titled,
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
void GuessGyroUnit(const Windows& forces, const Windows& windows,
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
void GuessRate(const Readings& accel, const Readings& gyro, double gravity,
               ImuGuess* guess) {
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
  if (file.rows < 4 * kWindow) return std::nullopt;
  ImuGuess guess;
  const auto accel = TitledTriple(meanings, "accel_");
  const auto gyro = TitledTriple(meanings, "gyro_");
  if (accel && gyro) {
    guess.accel.columns = *accel;
    guess.gyro.columns = *gyro;
    const Readings f(file, *accel);
    guess.turn = TurnOf(f, Readings(file, *gyro), WindowsOf(f).quiet_length);
  } else if (accel || gyro ||
             !FindUntitled(file, meanings, stamp_column, &guess)) {
    return std::nullopt;
  }
  const auto titled = [&](const TripleGuess& triple) {
    return meanings[static_cast<std::size_t>(triple.columns[0])].unit;
  };
  const Windows forces = WindowsOf(Readings(file, guess.accel.columns));
  const Windows rates = WindowsOf(Readings(file, guess.gyro.columns));
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
    GuessRate(Readings(file, guess.accel.columns),
              Readings(file, guess.gyro.columns), forces.quiet_length, &guess);
  }
  return guess;
}

bool FeelsGravity(const ImuGuess& guess) {
  constexpr double kTolerance = 0.2;
  return std::abs(guess.quiet / kStandardGravity - 1.0) < kTolerance;
}

}  // namespace hindsight
