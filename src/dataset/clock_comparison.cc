#include "dataset/clock_comparison.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "base/units.h"
#include "dataset/clock_rows.h"
#include "dataset/clock_windows.h"
#include "dataset/held_motion.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

constexpr double kShortestWindow = 0.5;  // [s]
constexpr double kLongestWindow = 5.0;   // [s]
constexpr double kFineEnough = 0.3;      // noise of an acceleration [m/s^2]
constexpr double kFineTurn = 0.01;       // noise of a turn [rad/s]
constexpr double kFewestWindows = 5.0;   // that do not overlap
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Over which the gyros' bias turns the held axes by some 3 deg.
double PieceLength(const InitialState& initial) {
  constexpr double kUsualBias = 0.2 * kDegree;
  constexpr double kTurn = 0.05;
  const double bias = initial.gyro_bias_sigma
                          ? initial.gyro_bias_sigma->maxCoeff()
                          : kUsualBias;
  return std::clamp(kTurn / bias, 5.0, 15.0);
}

/// What all comparisons hold: motion, rows and windows.
struct Comparison {
  HeldMotion motion;
  TimedRows rows;
  ClockWindows windows;

  /// Hands the windows that the IMU covers, piece by piece, to `add`.
  template <typename Add>
  bool ForEachWindow(double offset, const Add& add) const {
    double independent = 0.0, covered = -kNever;
    for (std::size_t i = 0; i < windows.windows.size(); ++i) {
      const ClockWindows::Window& w = windows.windows[i];
      if (!motion.Covers(rows.t[w.begin] + offset) ||
          !motion.Covers(rows.t[w.end] + offset)) {
        continue;
      }
      if (rows.t[w.begin] >= covered) {
        independent += 1.0;
        covered = rows.t[w.end];
      }
      add(i, w);
    }
    return independent >= kFewestWindows;
  }

  HeldMotion::Instant At(std::size_t row, double offset) const {
    return motion.At(rows.t[row] + offset);
  }
};

double Ratio(const std::map<int, CommonMotion>& pieces, bool rotates) {
  constexpr int kFewestInPiece = 4;
  double left = 0.0, moved = 0.0;
  for (const auto& [piece, common] : pieces) {
    if (common.count() < kFewestInPiece) continue;
    left += rotates ? common.LeftByRotation() : common.LeftByConstant();
    moved += common.Motion();
  }
  return moved > 0.0 ? left / moved : kNever;
}

/// (x_end - x_middle) / dt_2 - (x_middle - x_begin) / dt_1, over the time
/// between.
template <typename Get>
Eigen::Vector3d SecondDifference(const ClockWindows::Window& w,
                                 const std::vector<double>& t, const Get& get) {
  const double dt_1 = t[w.middle] - t[w.begin];
  const double dt_2 = t[w.end] - t[w.middle];
  const Eigen::Vector3d x = get(w.middle);
  const Eigen::Vector3d before = (x - get(w.begin)) / dt_1;
  const Eigen::Vector3d after = (get(w.end) - x) / dt_2;
  return (after - before) / (0.5 * (dt_1 + dt_2));
}

/// Accelerations less gravity in n, one a window.
std::vector<Eigen::Vector3d> Accelerations(const TimedRows& rows,
                                           const ClockWindows& windows,
                                           bool of_positions) {
  const Eigen::Vector3d g_n(0.0, 0.0, kStandardGravity);
  std::vector<Eigen::Vector3d> a;
  for (const ClockWindows::Window& w : windows.windows) {
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

double ForceMisfit(const Comparison& c, const std::vector<Eigen::Vector3d>& a,
                   bool of_positions, double offset) {
  std::map<int, CommonMotion> pieces;
  const bool enough = c.ForEachWindow(
      offset, [&](std::size_t i, const ClockWindows::Window& w) {
        const Eigen::Vector3d b =
            of_positions
                ? SecondDifference(
                      w, c.rows.t,
                      [&](std::size_t k) { return c.At(k, offset).p; })
                : Eigen::Vector3d(
                      (c.At(w.end, offset).v - c.At(w.begin, offset).v) /
                      (c.rows.t[w.end] - c.rows.t[w.begin]));
        pieces[w.piece].Add(a[i], b);
      });
  return enough ? Ratio(pieces, true) : kNever;
}

double BodyVelocityMisfit(const Comparison& c, double offset) {
  std::map<int, CommonMotion> pieces;
  const bool enough =
      c.ForEachWindow(offset, [&](std::size_t, const ClockWindows::Window& w) {
        const HeldMotion::Instant begin = c.At(w.begin, offset);
        const HeldMotion::Instant end = c.At(w.end, offset);
        const double dt = c.rows.t[w.end] - c.rows.t[w.begin];
        pieces[w.piece].Add(
            (end.q * c.rows.value[w.end] - begin.q * c.rows.value[w.begin]) /
                dt,
            (end.v - begin.v) / dt);
      });
  return enough ? Ratio(pieces, false) : kNever;
}

/// With R the turn from begin to end, R m_end - m_begin = (R - 1) h, h the hard
/// iron.
double FieldMisfit(const Comparison& c, double offset) {
  Eigen::Matrix3d N = Eigen::Matrix3d::Identity() * 1e-9;
  Eigen::Vector3d rhs = Eigen::Vector3d::Zero();
  Eigen::Vector3d turned_with = Eigen::Vector3d::Zero();
  double square = 0.0, changed = 0.0, turned = 0.0;
  const bool enough =
      c.ForEachWindow(offset, [&](std::size_t, const ClockWindows::Window& w) {
        const Eigen::Matrix3d A =
            (c.At(w.begin, offset).q.conjugate() * c.At(w.end, offset).q)
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
  if (!enough) return kNever;
  const Eigen::Vector3d h = N.ldlt().solve(rhs);
  const double of_iron = h.dot(N * h);
  const double left = square - 2.0 * h.dot(rhs) + of_iron;
  turned += of_iron - 2.0 * h.dot(turned_with);
  return std::max(0.0, left) / (0.5 * (changed + turned));
}

/// The vertical u of each piece by least squares: acceleration + g = u . b.
double HeightMisfit(const Comparison& c, const std::vector<double>& up,
                    double offset) {
  struct Sums {
    Eigen::Matrix3d N = Eigen::Matrix3d::Identity() * 1e-9;
    Eigen::Vector3d rhs = Eigen::Vector3d::Zero();
    double square = 0.0, sum = 0.0, count = 0.0;
  };
  std::map<int, Sums> pieces;
  const bool enough = c.ForEachWindow(
      offset, [&](std::size_t i, const ClockWindows::Window& w) {
        const Eigen::Vector3d b = SecondDifference(
            w, c.rows.t, [&](std::size_t k) { return c.At(k, offset).p; });
        Sums& s = pieces[w.piece];
        const double y = up[i] + kStandardGravity;
        s.N += b * b.transpose();
        s.rhs += b * y;
        s.square += y * y;
        s.sum += y;
        s.count += 1.0;
      });
  if (!enough) return kNever;
  double left = 0.0, moved = 0.0;
  for (const auto& [piece, s] : pieces) {
    const double fitted = s.rhs.dot(s.N.ldlt().solve(s.rhs));
    const double about_mean = s.square - s.sum * s.sum / s.count;
    const double residual = std::max(0.0, s.square - fitted);
    left += residual;
    moved += std::max(residual, about_mean);
  }
  return moved > 0.0 ? 2.0 * left / moved : kNever;
}

/// Time over which noise falls to what is fine enough, of a value that is
/// differenced once or twice.
double WindowLength(double sigma, bool twice) {
  const double length = twice ? std::sqrt(std::sqrt(6.0) * sigma / kFineEnough)
                              : std::sqrt(2.0) * sigma / kFineEnough;
  return std::clamp(length, kShortestWindow, kLongestWindow);
}

double FieldWindowLength(const TimedRows& rows) {
  double norm = 0.0;
  for (const Eigen::Vector3d& field : rows.value) norm += field.norm();
  norm /= static_cast<double>(rows.value.size());
  return std::clamp(std::sqrt(2.0) * rows.MedianSigma() / (kFineTurn * norm),
                    kShortestWindow, kLongestWindow);
}

ClockComparison Finish(const std::shared_ptr<const Comparison>& c,
                       std::string compared, double components,
                       std::function<double(double)> misfit) {
  return {.misfit = std::move(misfit),
          .first = c->rows.t.front(),
          .last = c->rows.t.back(),
          .resolution = c->windows.length,
          .freedom = components * c->windows.IndependentWindows(c->rows.t),
          .compared = std::move(compared)};
}

}  // namespace

std::optional<ClockComparison> CompareStream(const ImuStream& imu,
                                             const InitialState& initial,
                                             const AidingStream& stream) {
  constexpr std::size_t kFewestRows = 10;
  if (imu.empty() || stream.measurements.empty()) return std::nullopt;
  const MeasurementModel& model = stream.measurements.front().model;
  const bool positions = std::holds_alternative<PositionFix>(model);
  const bool heights = std::holds_alternative<HeightFix>(model);
  const bool fields = std::holds_alternative<MagneticField>(model);
  const bool in_body = std::holds_alternative<Dvl>(model) ||
                       std::holds_alternative<Odometer>(model);
  const bool generated = stream.sensor.type == SensorType::kNonHolonomic;
  TimedRows rows = RowsOf(stream);
  if (generated || rows.t.size() < kFewestRows) return std::nullopt;
  const bool twice = positions || heights;
  const double length = fields ? FieldWindowLength(rows)
                               : WindowLength(rows.MedianSigma(), twice);
  ClockWindows windows =
      MakeWindows(rows.t, length, twice, PieceLength(initial));
  if (windows.windows.empty()) return std::nullopt;
  const auto c = std::make_shared<const Comparison>(Comparison{
      HeldMotion(imu, initial.gyro_bias), std::move(rows), std::move(windows)});
  if (fields) {
    return Finish(c, "turns", 2.0,
                  [c](double offset) { return FieldMisfit(*c, offset); });
  }
  if (in_body) {
    return Finish(c, "accelerations", 1.0, [c](double offset) {
      return BodyVelocityMisfit(*c, offset);
    });
  }
  if (heights) {
    std::vector<double> up;
    for (const ClockWindows::Window& w : c->windows.windows) {
      up.push_back(SecondDifference(w, c->rows.t, [&](std::size_t k) {
                     return c->rows.value[k];
                   }).x());
    }
    return Finish(c, "vertical accelerations", 1.0, [c, up](double offset) {
      return HeightMisfit(*c, up, offset);
    });
  }
  const auto a = Accelerations(c->rows, c->windows, positions);
  return Finish(c, "accelerations", 3.0, [c, a, positions](double offset) {
    return ForceMisfit(*c, a, positions, offset);
  });
}

std::optional<ClockComparison> CompareTurns(
    const ImuStream& imu, const std::vector<TruthPoint>& truth) {
  constexpr int kFewestTurns = 20;
  struct Turns {
    HeldMotion motion;
    std::vector<double> t;
    ClockWindows windows;
    std::vector<Eigen::Vector3d> turned;  ///< by the truth, in the body [rad]
  };
  std::vector<double> t;
  std::vector<const TruthPoint*> points;
  for (const TruthPoint& point : truth) {
    if (!point.q_nb || (!t.empty() && point.t <= t.back())) continue;
    t.push_back(point.t);
    points.push_back(&point);
  }
  if (imu.empty() || t.size() < 2) return std::nullopt;
  ClockWindows windows = MakeWindows(t, kShortestWindow, false, kNever);
  if (windows.windows.empty()) return std::nullopt;
  std::vector<Eigen::Vector3d> turned;
  for (const ClockWindows::Window& w : windows.windows) {
    const TruthPoint& a = *points[w.begin];
    Eigen::Quaterniond q = a.q_nb->conjugate() * *points[w.end]->q_nb;
    if (a.p_e) {
      const Eigen::Vector3d earth_n =
          NedAxes(*a.p_e).transpose() * EarthRate_e();
      q = Exp(a.q_nb->conjugate() * ((t[w.end] - t[w.begin]) * earth_n)) * q;
    }
    turned.push_back(Log(q));
  }
  const auto c = std::make_shared<const Turns>(
      Turns{HeldMotion(imu, Eigen::Vector3d::Zero()), std::move(t),
            std::move(windows), std::move(turned)});
  const auto misfit = [c](double offset) {
    CommonMotion common;
    double left = 0.0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < c->windows.windows.size(); ++i) {
      const ClockWindows::Window& w = c->windows.windows[i];
      const double from = c->t[w.begin] + offset;
      const double to = c->t[w.end] + offset;
      if (!c->motion.Covers(from) || !c->motion.Covers(to)) continue;
      const Eigen::Quaterniond turn =
          c->motion.At(from).q.conjugate() * c->motion.At(to).q;
      const Eigen::Vector3d r = Log(Exp(c->turned[i]).conjugate() * turn);
      common.Add(c->turned[i], Log(turn));
      left += r.squaredNorm();
      sum += r;
    }
    if (common.count() < kFewestTurns) return kNever;
    left -= sum.squaredNorm() / common.count();
    return left / common.Motion();
  };
  return ClockComparison{.misfit = misfit,
                         .first = c->t.front(),
                         .last = c->t.back(),
                         .resolution = c->windows.length,
                         .freedom = 3.0 * c->windows.IndependentWindows(c->t),
                         .compared = "turns"};
}

}  // namespace hindsight
