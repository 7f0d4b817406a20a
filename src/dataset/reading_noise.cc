#include "dataset/reading_noise.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace hindsight {
namespace {

/// Mean squares of second differences over windows of a second.
struct WindowSquares {
  std::vector<double> gyro;
  std::vector<double> accel;
};

WindowSquares SquaresOf(const ImuStream& imu, double dt) {
  constexpr double kSecondDifference = 6.0;
  constexpr double kAxes = 3.0;
  const double scale =
      imu.kind == ImuStream::Kind::kIncrements ? 1.0 / dt : 1.0;
  const auto window = static_cast<std::size_t>(std::max(8.0, 1.0 / dt));
  WindowSquares squares;
  const auto& s = imu.samples;
  for (std::size_t k = 1; k + window + 1 < s.size(); k += window) {
    double gyro = 0.0;
    double accel = 0.0;
    for (std::size_t i = k; i < k + window; ++i) {
      gyro += (s[i - 1].gyro - 2.0 * s[i].gyro + s[i + 1].gyro).squaredNorm();
      accel +=
          (s[i - 1].accel - 2.0 * s[i].accel + s[i + 1].accel).squaredNorm();
    }
    const double each =
        scale * scale /
        (kSecondDifference * kAxes * static_cast<double>(window));
    squares.gyro.push_back(gyro * each);
    squares.accel.push_back(accel * each);
  }
  return squares;
}

double Mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double LowestTenth(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.resize(std::max<std::size_t>(1, values.size() / 10));
  return Mean(values);
}

}  // namespace

ReadingNoise NoiseOfReadings(const ImuStream& imu) {
  if (imu.empty()) return {};
  const double dt = MedianInterval(imu);
  if (dt <= 0.0) return {};
  const WindowSquares squares = SquaresOf(imu, dt);
  if (squares.gyro.empty()) return {};
  const auto density = [&](double square) { return std::sqrt(square * dt); };
  return {density(Mean(squares.gyro)), density(Mean(squares.accel)),
          density(LowestTenth(squares.gyro)),
          density(LowestTenth(squares.accel))};
}

}  // namespace hindsight
