#include "evaluation/interpolation.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "geometry/so3.h"

namespace hindsight {
namespace {

/// Stamps closer than this are the same instant: files keep nanoseconds.
constexpr double kSameInstant = 1e-9;

/// Neighbouring intervals may differ this much in length before their slope
/// says more about a jump at the row than about the motion.
constexpr double kComparable = 4.0;

struct Curve {
  Eigen::Vector3d value;
  Eigen::Vector3d slope;
};

/// The cubic with value 0 and slope m0 at u = 0, value d and slope m1 at u = 1,
/// u = (t - t0)/h.
Curve Cubic(const Eigen::Vector3d& d, const Eigen::Vector3d& m0,
            const Eigen::Vector3d& m1, double h, double u) {
  const double v = 1.0 - u;
  Curve curve;
  curve.value = u * u * (3.0 - 2.0 * u) * d + h * u * v * (v * m0 - u * m1);
  curve.slope =
      6.0 * u * v / h * d + v * (1.0 - 3.0 * u) * m0 + u * (3.0 * u - 2.0) * m1;
  return curve;
}

/// Slopes at both ends of interval k from the increments of the intervals
/// around it; `increment(i)` is that of interval i.
template <typename Increment>
std::pair<Eigen::Vector3d, Eigen::Vector3d> EndSlopes(
    const std::vector<double>& t, double max_gap, std::size_t k,
    const Increment& increment) {
  const auto central = [&](std::size_t row) -> std::optional<Eigen::Vector3d> {
    if (row == 0 || row + 1 >= t.size()) return std::nullopt;
    const double left = t[row] - t[row - 1];
    const double right = t[row + 1] - t[row];
    if (std::max(left, right) > max_gap ||
        std::max(left, right) > kComparable * std::min(left, right)) {
      return std::nullopt;
    }
    return ((right / left) * increment(row - 1) +
            (left / right) * increment(row)) /
           (left + right);
  };
  const Eigen::Vector3d chord = increment(k) / (t[k + 1] - t[k]);
  const std::optional<Eigen::Vector3d> begin = central(k);
  const std::optional<Eigen::Vector3d> end = central(k + 1);
  if (begin && end) return {*begin, *end};
  if (begin) return {*begin, 2.0 * chord - *begin};
  if (end) return {2.0 * chord - *end, *end};
  return {chord, chord};
}

Eigen::Matrix3d Blend(const std::vector<Eigen::Matrix3d>& P, std::size_t k,
                      double u) {
  return (1.0 - u) * P[k] + u * P[k + 1];
}

}  // namespace

TrajectoryInterpolator::TrajectoryInterpolator(const SolutionTable& table,
                                               double max_gap)
    : table_(table), max_gap_(max_gap) {}

std::optional<std::size_t> TrajectoryInterpolator::FindInterval(
    double t) const {
  const std::vector<double>& stamps = table_.t;
  if (stamps.size() < 2 || t < stamps.front() - kSameInstant ||
      t > stamps.back() + kSameInstant) {
    return std::nullopt;
  }
  const auto after = std::upper_bound(stamps.begin() + 1, stamps.end() - 1, t);
  const auto k = static_cast<std::size_t>(after - stamps.begin()) - 1;
  const bool at_row =
      t - stamps[k] <= kSameInstant || stamps[k + 1] - t <= kSameInstant;
  if (!at_row && stamps[k + 1] - stamps[k] > max_gap_) return std::nullopt;
  return k;
}

std::optional<InterpolatedState> TrajectoryInterpolator::AtOnlyRow(
    double t) const {
  if (table_.size() != 1 || std::abs(t - table_.t[0]) > kSameInstant) {
    return std::nullopt;
  }
  const auto first = [](const auto& column) {
    using Value = typename std::decay_t<decltype(column)>::value_type;
    return column.empty() ? std::optional<Value>() : column[0];
  };
  InterpolatedState x;
  x.t = t;
  x.p_e = first(table_.p_e);
  x.v_e = first(table_.v_e);
  x.q_eb = first(table_.q_eb);
  x.P_position = first(table_.P_position);
  x.P_velocity = first(table_.P_velocity);
  x.P_attitude = first(table_.P_attitude);
  return x;
}

void TrajectoryInterpolator::InterpolateMotion(std::size_t k, double h,
                                               double u,
                                               InterpolatedState* x) const {
  const auto difference = [](const std::vector<Eigen::Vector3d>& y) {
    return [&y](std::size_t i) -> Eigen::Vector3d { return y[i + 1] - y[i]; };
  };
  if (!table_.v_e.empty()) {
    const auto dv = difference(table_.v_e);
    const auto [m0, m1] = EndSlopes(table_.t, max_gap_, k, dv);
    x->v_e = table_.v_e[k] + Cubic(dv(k), m0, m1, h, u).value;
  }
  if (!table_.p_e.empty()) {
    const auto dp = difference(table_.p_e);
    const auto [m0, m1] = table_.v_e.empty()
                              ? EndSlopes(table_.t, max_gap_, k, dp)
                              : std::pair(table_.v_e[k], table_.v_e[k + 1]);
    x->p_e = table_.p_e[k] + Cubic(dp(k), m0, m1, h, u).value;
  }
  if (!table_.q_eb.empty()) {
    const std::vector<Eigen::Quaterniond>& q = table_.q_eb;
    const auto dq = [&q](std::size_t i) {
      return Log(q[i].conjugate() * q[i + 1]);
    };
    const auto [m0, m1] = EndSlopes(table_.t, max_gap_, k, dq);
    const Eigen::Vector3d d = dq(k);
    // The slopes are body rates; that of the rotation vector at the far end
    // differs from it by the right Jacobian.
    const Curve phi = Cubic(d, m0, RightJacobianInverse(d) * m1, h, u);
    x->q_eb = (q[k] * Exp(phi.value)).normalized();
    x->w_eb_b = RightJacobian(phi.value) * phi.slope;
  }
}

std::optional<InterpolatedState> TrajectoryInterpolator::At(double t) const {
  const std::optional<std::size_t> interval = FindInterval(t);
  if (!interval) return AtOnlyRow(t);
  const std::size_t k = *interval;
  const double h = table_.t[k + 1] - table_.t[k];
  const double u = std::clamp((t - table_.t[k]) / h, 0.0, 1.0);
  InterpolatedState x;
  x.t = t;
  InterpolateMotion(k, h, u, &x);
  if (!table_.P_position.empty()) x.P_position = Blend(table_.P_position, k, u);
  if (!table_.P_velocity.empty()) x.P_velocity = Blend(table_.P_velocity, k, u);
  if (!table_.P_attitude.empty()) x.P_attitude = Blend(table_.P_attitude, k, u);
  return x;
}

}  // namespace hindsight
