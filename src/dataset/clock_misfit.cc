#include "dataset/clock_misfit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <map>

#include "base/units.h"
#include "earth/wgs84.h"

namespace hindsight {
namespace {

constexpr double kFewestWindows = 5.0;  // that do not overlap

/// Hands the windows that the IMU covers, piece by piece, to `add`; false if
/// they are too few.
template <typename Add>
bool ForEachWindow(const ClockSeries& c, double offset, const Add& add) {
  double independent = 0.0, covered = -kNoMisfit;
  for (std::size_t i = 0; i < c.windows.windows.size(); ++i) {
    const ClockWindows::Window& w = c.windows.windows[i];
    if (!c.motion.Covers(c.rows.t[w.begin] + offset) ||
        !c.motion.Covers(c.rows.t[w.end] + offset)) {
      continue;
    }
    if (c.rows.t[w.begin] >= covered) {
      independent += 1.0;
      covered = c.rows.t[w.end];
    }
    add(i, w);
  }
  return independent >= kFewestWindows;
}

HeldMotion::Instant InstantOf(const ClockSeries& c, std::size_t row,
                              double offset) {
  return c.motion.At(c.rows.t[row] + offset);
}

double MisfitOf(const std::map<int, CommonMotion>& pieces, bool rotates) {
  constexpr int kFewestInPiece = 4;
  double left = 0.0, moved = 0.0;
  for (const auto& [piece, common] : pieces) {
    if (common.count() < kFewestInPiece) continue;
    left += rotates ? common.LeftByRotation() : common.LeftByConstant();
    moved += common.Motion();
  }
  return moved > 0.0 ? left / moved : kNoMisfit;
}

}  // namespace

std::vector<Eigen::Vector3d> Accelerations(const ClockSeries& c,
                                           bool of_positions) {
  const TimedRows& rows = c.rows;
  const Eigen::Vector3d g_n(0.0, 0.0, kStandardGravity);
  std::vector<Eigen::Vector3d> a;
  for (const ClockWindows::Window& w : c.windows.windows) {
    if (of_positions) {
      const Eigen::Vector3d a_e = SecondDifference(
          w, rows.t, [&](std::size_t k) { return rows.value[k]; });
      a.emplace_back(NedAxes(rows.value[w.middle]).transpose() * a_e - g_n);
    } else {
      a.emplace_back((rows.value[w.end] - rows.value[w.begin]) /
                         (rows.t[w.end] - rows.t[w.begin]) -
                     g_n);
    }
  }
  return a;
}

std::vector<double> VerticalAccelerations(const ClockSeries& c) {
  std::vector<double> up;
  for (const ClockWindows::Window& w : c.windows.windows) {
    up.push_back(SecondDifference(w, c.rows.t, [&](std::size_t k) {
                   return c.rows.value[k];
                 }).x());
  }
  return up;
}

double ForceMisfit(const ClockSeries& c, const std::vector<Eigen::Vector3d>& a,
                   bool of_positions, double offset) {
  std::map<int, CommonMotion> pieces;
  const bool enough = ForEachWindow(
      c, offset, [&](std::size_t i, const ClockWindows::Window& w) {
        const Eigen::Vector3d b =
            of_positions
                ? SecondDifference(
                      w, c.rows.t,
                      [&](std::size_t k) { return InstantOf(c, k, offset).p; })
                : Eigen::Vector3d((InstantOf(c, w.end, offset).v -
                                   InstantOf(c, w.begin, offset).v) /
                                  (c.rows.t[w.end] - c.rows.t[w.begin]));
        pieces[w.piece].Add(a[i], b);
      });
  return enough ? MisfitOf(pieces, true) : kNoMisfit;
}

double BodyVelocityMisfit(const ClockSeries& c, double offset) {
  std::map<int, CommonMotion> pieces;
  const bool enough =
      ForEachWindow(c, offset, [&](std::size_t, const ClockWindows::Window& w) {
        const HeldMotion::Instant begin = InstantOf(c, w.begin, offset);
        const HeldMotion::Instant end = InstantOf(c, w.end, offset);
        const double dt = c.rows.t[w.end] - c.rows.t[w.begin];
        pieces[w.piece].Add(
            (end.q * c.rows.value[w.end] - begin.q * c.rows.value[w.begin]) /
                dt,
            (end.v - begin.v) / dt);
      });
  return enough ? MisfitOf(pieces, false) : kNoMisfit;
}

double FieldMisfit(const ClockSeries& c, double offset) {
  Eigen::Matrix3d N = Eigen::Matrix3d::Identity() * 1e-9;
  Eigen::Vector3d rhs = Eigen::Vector3d::Zero();
  Eigen::Vector3d turned_with = Eigen::Vector3d::Zero();
  double square = 0.0, changed = 0.0, turned = 0.0;
  const bool enough =
      ForEachWindow(c, offset, [&](std::size_t, const ClockWindows::Window& w) {
        const Eigen::Matrix3d A = (InstantOf(c, w.begin, offset).q.conjugate() *
                                   InstantOf(c, w.end, offset).q)
                                      .toRotationMatrix() -
                                  Eigen::Matrix3d::Identity();
        const Eigen::Vector3d& m = c.rows.value[w.end];
        const Eigen::Vector3d change = m - c.rows.value[w.begin];
        const Eigen::Vector3d d = A * m + change;
        N += A.transpose() * A;
        rhs += A.transpose() * d;
        turned_with += A.transpose() * (A * m);
        turned += (A * m).squaredNorm();
        square += d.squaredNorm();
        changed += change.squaredNorm();
      });
  if (!enough) return kNoMisfit;
  const Eigen::Vector3d h = N.ldlt().solve(rhs);
  const double of_iron = h.dot(N * h);
  const double left = square - 2.0 * h.dot(rhs) + of_iron;
  turned += of_iron - 2.0 * h.dot(turned_with);
  return std::max(0.0, left) / (0.5 * (changed + turned));
}

double HeightMisfit(const ClockSeries& c, const std::vector<double>& up,
                    double offset) {
  struct Sums {
    Eigen::Matrix3d N = Eigen::Matrix3d::Identity() * 1e-9;
    Eigen::Vector3d rhs = Eigen::Vector3d::Zero();
    double square = 0.0, sum = 0.0, count = 0.0;
  };
  std::map<int, Sums> pieces;
  const bool enough = ForEachWindow(
      c, offset, [&](std::size_t i, const ClockWindows::Window& w) {
        const Eigen::Vector3d b = SecondDifference(
            w, c.rows.t,
            [&](std::size_t k) { return InstantOf(c, k, offset).p; });
        Sums& s = pieces[w.piece];
        const double y = up[i] + kStandardGravity;
        s.N += b * b.transpose();
        s.rhs += b * y;
        s.square += y * y;
        s.sum += y;
        s.count += 1.0;
      });
  if (!enough) return kNoMisfit;
  double left = 0.0, moved = 0.0;
  for (const auto& [piece, s] : pieces) {
    const double fitted = s.rhs.dot(s.N.ldlt().solve(s.rhs));
    const double about_mean = s.square - s.sum * s.sum / s.count;
    const double residual = std::max(0.0, s.square - fitted);
    left += residual;
    moved += std::max(residual, about_mean);
  }
  return moved > 0.0 ? 2.0 * left / moved : kNoMisfit;
}

}  // namespace hindsight
