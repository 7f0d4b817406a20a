#include "simulation/sampled_trajectory.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

/// Derivative at the middle (side = 0), first (-1) or last (+1) of three points
/// of the parabola through them: d0, d1 are the mean slopes of the two
/// intervals h0, h1.
Eigen::Vector3d ParabolaSlope(double h0, const Eigen::Vector3d& d0, double h1,
                              const Eigen::Vector3d& d1, int side) {
  const Eigen::Vector3d curvature = (d1 - d0) / (h0 + h1);
  if (side < 0) return d0 - h0 * curvature;
  if (side > 0) return d1 + h1 * curvature;
  return d0 + h0 * curvature;
}

/// Middle of the three points that give the slope at node k of n.
std::size_t MiddleOf(std::size_t k, std::size_t n) {
  return std::clamp<std::size_t>(k, 1, n - 2);
}

int SideOf(std::size_t k, std::size_t middle) {
  return k < middle ? -1 : (k > middle ? 1 : 0);
}

void FillSlopes(std::vector<Motion>* nodes) {
  auto& x = *nodes;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const std::size_t m = MiddleOf(k, x.size());
    const int side = SideOf(k, m);
    const double h0 = x[m].t - x[m - 1].t;
    const double h1 = x[m + 1].t - x[m].t;
    x[k].a_e = ParabolaSlope(h0, (x[m].v_e - x[m - 1].v_e) / h0, h1,
                             (x[m + 1].v_e - x[m].v_e) / h1, side);
    const Eigen::Vector3d before = Log(x[m - 1].q_eb.conjugate() * x[m].q_eb);
    const Eigen::Vector3d after = Log(x[m].q_eb.conjugate() * x[m + 1].q_eb);
    // The parabola runs in the tangent at the middle point.
    const Eigen::Vector3d slope =
        ParabolaSlope(h0, before / h0, h1, after / h1, side);
    Eigen::Vector3d from_middle = Eigen::Vector3d::Zero();
    if (side < 0) from_middle = -before;
    if (side > 0) from_middle = after;
    x[k].w_eb_b = RightJacobian(from_middle) * slope;
  }
}

}  // namespace

SampledTrajectory::SampledTrajectory(const std::vector<ProfilePoint>& points) {
  if (points.size() < 3) {
    throw InputError("motion profile: " + std::to_string(points.size()) +
                     " points, expected at least 3");
  }
  nodes_.reserve(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const ProfilePoint& point = points[k];
    if (k > 0 && !(point.t > points[k - 1].t)) {
      throw InputError("motion profile: point " + std::to_string(k + 1) +
                       " is not later than the one before");
    }
    const Eigen::Matrix3d C_en =
        NedAxes(point.position.latitude, point.position.longitude);
    Motion node;
    node.t = point.t;
    node.v_e = C_en * point.v_n;
    node.q_eb =
        Eigen::Quaterniond(C_en) *
        QuaternionFromEuler(point.euler.x(), point.euler.y(), point.euler.z());
    node.q_eb.normalize();
    nodes_.push_back(node);
  }
  FillSlopes(&nodes_);
  nodes_.front().p_e = EcefFromGeodetic(points.front().position);
  for (std::size_t k = 1; k < nodes_.size(); ++k) {
    const Motion& a = nodes_[k - 1];
    Motion& b = nodes_[k];
    const double h = b.t - a.t;
    b.p_e =
        a.p_e + (0.5 * h) * (a.v_e + b.v_e) + (h * h / 12.0) * (a.a_e - b.a_e);
    largest_deviation_ =
        std::max(largest_deviation_,
                 (b.p_e - EcefFromGeodetic(points[k].position)).norm());
  }
}

Motion SampledTrajectory::At(double t) {
  const std::size_t last = nodes_.size() - 2;
  hint_ = std::min(hint_, last);
  if (!(nodes_[hint_].t <= t && t < nodes_[hint_ + 1].t)) {
    const auto it = std::upper_bound(
        nodes_.begin() + 1, nodes_.end() - 1, t,
        [](double value, const Motion& m) { return value < m.t; });
    hint_ = static_cast<std::size_t>(it - nodes_.begin()) - 1;
  }
  const Motion& a = nodes_[hint_];
  const Motion& b = nodes_[hint_ + 1];
  const double h = b.t - a.t;
  const double s = (t - a.t) / h;
  const double s2 = s * s;

  // v = v_a + h a_a s + c2 s^2 + c3 s^3 and its integral and derivative.
  const Eigen::Vector3d dv = b.v_e - a.v_e;
  const Eigen::Vector3d c2 = 3.0 * dv - h * (2.0 * a.a_e + b.a_e);
  const Eigen::Vector3d c3 = h * (a.a_e + b.a_e) - 2.0 * dv;
  Motion m;
  m.t = t;
  m.p_e = a.p_e + (h * s) * (a.v_e + (0.5 * h * s) * a.a_e + (s2 / 3.0) * c2 +
                             (0.25 * s2 * s) * c3);
  m.v_e = a.v_e + (h * s) * a.a_e + s2 * c2 + (s2 * s) * c3;
  m.a_e = a.a_e + ((2.0 * s) * c2 + (3.0 * s2) * c3) / h;

  const Eigen::Vector3d phi = Log(a.q_eb.conjugate() * b.q_eb);
  const Eigen::Vector3d slope_a = h * a.w_eb_b;
  const Eigen::Vector3d slope_b = h * (RightJacobianInverse(phi) * b.w_eb_b);
  const Eigen::Vector3d r2 = 3.0 * phi - 2.0 * slope_a - slope_b;
  const Eigen::Vector3d r3 = slope_a + slope_b - 2.0 * phi;
  const Eigen::Vector3d theta = s * slope_a + s2 * r2 + (s2 * s) * r3;
  m.q_eb = (a.q_eb * Exp(theta)).normalized();
  m.w_eb_b =
      RightJacobian(theta) * (slope_a + (2.0 * s) * r2 + (3.0 * s2) * r3) / h;
  return m;
}

}  // namespace hindsight
