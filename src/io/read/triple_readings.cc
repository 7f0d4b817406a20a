#include "io/read/triple_readings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/median.h"

namespace hindsight {

TripleReadings::TripleReadings(const FileColumns& file,
                               const ColumnTriple& columns) {
  constexpr std::size_t kMostRows = 300'000;
  for (std::size_t i = 0; i < 3; ++i) {
    values_[i] = &file.columns[static_cast<std::size_t>(columns[i])].values;
  }
  rows_ = std::min(file.rows, kMostRows);
}

ReadingWindows WindowsOf(const TripleReadings& readings) {
  ReadingWindows windows;
  std::vector<double> lengths;
  for (std::size_t k = 0; k + kReadingWindow <= readings.rows();
       k += kReadingWindow) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double squares = 0.0;
    for (std::size_t i = k; i < k + kReadingWindow; ++i) {
      const Eigen::Vector3d v = readings.at(i);
      sum += v;
      squares += v.squaredNorm();
      if (v.allFinite()) lengths.push_back(v.norm());
    }
    const Eigen::Vector3d mean = sum / static_cast<double>(kReadingWindow);
    const double variance =
        squares / static_cast<double>(kReadingWindow) - mean.squaredNorm();
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

GravityTurn TurnOf(const TripleReadings& field, const TripleReadings& gyro,
                   double length) {
  constexpr double kAlike = 0.1;
  double across = 0.0;
  double predicted = 0.0;
  double seen = 0.0;
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < gyro.rows(); ++k) bias += gyro.at(k);
  bias /= static_cast<double>(std::max<std::size_t>(1, gyro.rows()));
  constexpr std::size_t kMean = 5;
  for (std::size_t k = 0; k + kReadingWindow + kMean < field.rows();
       k += kReadingWindow / 2) {
    Eigen::Vector3d before = Eigen::Vector3d::Zero();
    Eigen::Vector3d behind = Eigen::Vector3d::Zero();
    Eigen::Vector3d turn = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < kMean; ++i) {
      before += field.at(k + i);
      behind += field.at(k + kReadingWindow + i);
    }
    for (std::size_t i = 0; i < kReadingWindow; ++i) {
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

}  // namespace hindsight
