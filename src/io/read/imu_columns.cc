#include "io/read/imu_columns.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"
#include "io/read/units.h"

namespace hindsight {

StampGuess CountedImu(const ImuGuess& guess) {
  constexpr std::array kUsual = {20.0,  25.0,  30.0,  50.0,  60.0,  100.0,
                                 104.0, 120.0, 125.0, 200.0, 208.0, 250.0,
                                 256.0, 300.0, 400.0, 416.0, 500.0, 1000.0};
  constexpr double kGyroScale = 0.03;  // of an uncalibrated gyro
  StampGuess stamps;
  stamps.certainty = Certainty::kGuess;
  if (!guess.rate) {
    stamps.rate = 100.0;
    stamps.reason =
        "rows are counted, not stamped, and the motion does not show their "
        "rate";
  } else {
    const double found = guess.rate->rate;
    const auto distance = [&](double rate) {
      return std::abs(std::log(rate / found));
    };
    const double nearest = *std::min_element(
        kUsual.begin(), kUsual.end(),
        [&](double a, double b) { return distance(a) < distance(b); });
    const double sigma = std::hypot(guess.rate->log_sigma, kGyroScale);
    stamps.rate = distance(nearest) < 2.0 * sigma ? nearest : found;
    stamps.certainty = Certainty::kLikely;
    stamps.reason = fmt::format(
        "rows are counted, not stamped; between {} quiet spells gravity is "
        "balanced at {:.1f} +- {:.1f} Hz",
        guess.rate->spans, found, sigma * found);
  }
  stamps.step = 1.0 / *stamps.rate;
  return stamps;
}

std::optional<int> SpinAxis(const FileColumns& file, const ImuGuess& guess) {
  constexpr double kFast = 100.0 * kDegree;
  constexpr double kOften = 0.2;
  const auto factor =
      UnitFactor(guess.gyro.unit, Quantity::kAngularRate).value_or(1.0);
  std::array<double, 3> squares = {};
  std::size_t fast = 0;
  for (std::size_t k = 0; k < file.rows; ++k) {
    double rate = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto column = static_cast<std::size_t>(guess.gyro.columns[i]);
      const double w = factor * file.columns[column].values[k];
      squares[i] += w * w;
      rate = std::hypot(rate, w);
    }
    if (rate > kFast) ++fast;
  }
  const auto most = std::max_element(squares.begin(), squares.end());
  const double sum = squares[0] + squares[1] + squares[2];
  constexpr double kAlone = 0.9;
  if (static_cast<double>(fast) < kOften * static_cast<double>(file.rows) ||
      *most < kAlone * sum) {
    return std::nullopt;
  }
  return static_cast<int>(most - squares.begin());
}

}  // namespace hindsight
