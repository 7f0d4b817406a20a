#include "dataset/clock_turns.h"

#include <limits>
#include <memory>
#include <utility>

#include "dataset/clock_misfit.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

struct TurnSeries {
  HeldMotion motion;
  std::vector<double> t;
  ClockWindows windows;
  std::vector<Eigen::Vector3d> turned;  ///< by the truth, in the body [rad]
};

/// By the truth, in the body, one a window; less the Earth's where positions
/// tell it.
std::vector<Eigen::Vector3d> TurnsOf(const std::vector<double>& t,
                                     const TruthSeries& points,
                                     const ClockWindows& windows) {
  std::vector<Eigen::Vector3d> turned;
  for (const ClockWindows::Window& w : windows.windows) {
    const TruthPoint a = points[w.begin];
    Eigen::Quaterniond q = a.q_nb->conjugate() * *points[w.end].q_nb;
    if (a.p_e) {
      const Eigen::Vector3d earth_n =
          NedAxes(*a.p_e).transpose() * EarthRate_e();
      q = Exp(a.q_nb->conjugate() * ((t[w.end] - t[w.begin]) * earth_n)) * q;
    }
    turned.push_back(Log(q));
  }
  return turned;
}

double TurnMisfit(const TurnSeries& c, double offset) {
  constexpr int kFewestTurns = 20;
  CommonMotion common;
  double left = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < c.windows.windows.size(); ++i) {
    const ClockWindows::Window& w = c.windows.windows[i];
    const double from = c.t[w.begin] + offset;
    const double to = c.t[w.end] + offset;
    if (!c.motion.Covers(from) || !c.motion.Covers(to)) continue;
    const Eigen::Quaterniond turn =
        c.motion.At(from).q.conjugate() * c.motion.At(to).q;
    const Eigen::Vector3d r = Log(Exp(c.turned[i]).conjugate() * turn);
    common.Add(c.turned[i], Log(turn));
    left += r.squaredNorm();
    sum += r;
  }
  if (common.count() < kFewestTurns) return kNoMisfit;
  left -= sum.squaredNorm() / common.count();
  return left / common.Motion();
}

}  // namespace

std::optional<ClockComparison> CompareTurns(const ImuStream& imu,
                                            const TruthSeries& truth) {
  std::vector<double> t;
  TruthSeries points;
  for (const TruthPoint& point : truth) {
    if (!point.q_nb || (!t.empty() && point.t <= t.back())) continue;
    t.push_back(point.t);
    points.push_back(point);
  }
  if (imu.empty() || t.size() < 2) return std::nullopt;
  constexpr double kOnePiece = std::numeric_limits<double>::infinity();
  ClockWindows windows = MakeWindows(t, kShortestClockWindow, false, kOnePiece);
  if (windows.windows.empty()) return std::nullopt;
  std::vector<Eigen::Vector3d> turned = TurnsOf(t, points, windows);
  const auto c = std::make_shared<const TurnSeries>(
      TurnSeries{HeldMotion(imu, Eigen::Vector3d::Zero()), std::move(t),
                 std::move(windows), std::move(turned)});
  return ClockComparison{
      .misfit = [c](double offset) { return TurnMisfit(*c, offset); },
      .first = c->t.front(),
      .last = c->t.back(),
      .resolution = c->windows.length,
      .freedom = 3.0 * c->windows.IndependentWindows(c->t),
      .compared = "turns"};
}

}  // namespace hindsight
