#include "dataset/fix_noise.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "base/median.h"
#include "dataset/clock_comparison.h"
#include "dataset/clock_misfit.h"
#include "earth/wgs84.h"

namespace hindsight {
namespace {

constexpr std::size_t kFewest = 20;

std::optional<double> ByThirdDifferences(const TimedRows& rows) {
  constexpr double kThirdDifference = 20.0;
  constexpr double kMedianOfNormal = 0.6745;
  constexpr double kEven = 0.1;  // of a step
  if (rows.t.size() < kFewest) return std::nullopt;
  const double step = MedianStep(rows.t);
  const Eigen::Matrix3d C_ne = NedAxes(rows.value.front()).transpose();
  std::array<std::vector<double>, 3> differences;
  for (std::size_t k = 3; k < rows.t.size(); ++k) {
    bool even = true;
    for (std::size_t i = k - 2; i <= k; ++i) {
      even = even && std::abs(rows.t[i] - rows.t[i - 1] - step) <= kEven * step;
    }
    if (!even) continue;
    const Eigen::Vector3d d =
        C_ne * (rows.value[k] - rows.value[k - 3] -
                3.0 * (rows.value[k - 1] - rows.value[k - 2]));
    for (int axis = 0; axis < 3; ++axis) {
      differences[static_cast<std::size_t>(axis)].push_back(std::abs(d(axis)));
    }
  }
  if (differences[0].size() < kFewest) return std::nullopt;
  double square = 0.0;
  for (std::vector<double>& axis : differences) {
    const double sigma = Median(std::move(axis)) / kMedianOfNormal;
    square += sigma * sigma / kThirdDifference;
  }
  return std::sqrt(square / 3.0);
}

std::optional<double> AgainstImu(const ImuStream& imu,
                                 const InitialState& initial,
                                 const AidingStream& stream) {
  constexpr double kSecondDifference = 6.0;
  constexpr double kPiece = 5.0;  // s
  constexpr int kFewestInPiece = 4;
  TimedRows rows = RowsOf(stream);
  if (imu.empty() || rows.t.size() < kFewest) return std::nullopt;
  ClockWindows windows =
      MakeWindows(rows.t, kShortestClockWindow, true, kPiece);
  const ClockSeries c = {HeldMotion(imu, initial.gyro_bias), std::move(rows),
                         std::move(windows)};
  const std::vector<Eigen::Vector3d> a = Accelerations(c, true);
  const double offset = stream.sensor.time_offset;
  std::map<int, CommonMotion> pieces;
  double lengths = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const ClockWindows::Window& w = c.windows.windows[i];
    if (!c.motion.Covers(c.rows.t[w.begin] + offset) ||
        !c.motion.Covers(c.rows.t[w.end] + offset)) {
      continue;
    }
    pieces[w.piece].Add(a[i], SecondDifference(w, c.rows.t, [&](auto k) {
                          return c.motion.At(c.rows.t[k] + offset).p;
                        }));
    lengths += 0.5 * (c.rows.t[w.end] - c.rows.t[w.begin]);
    ++count;
  }
  double left = 0.0;
  double freedom = 0.0;
  for (const auto& [piece, common] : pieces) {
    if (common.count() < kFewestInPiece) continue;
    left += common.LeftByRotation();
    freedom += 3.0 * (common.count() - 1);
  }
  if (freedom < 3.0 * static_cast<double>(kFewest)) return std::nullopt;
  const double length = lengths / static_cast<double>(count);
  return std::sqrt(left / freedom / kSecondDifference) * length * length;
}

}  // namespace

std::optional<double> NoiseOfFixes(const ImuStream& imu,
                                   const InitialState& initial,
                                   const AidingStream& stream) {
  const auto alone = ByThirdDifferences(RowsOf(stream));
  const auto against = AgainstImu(imu, initial, stream);
  if (!alone || !against) return alone ? alone : against;
  return std::min(*alone, *against);
}

}  // namespace hindsight
