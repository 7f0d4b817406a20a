#include "state/chart.h"

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

namespace hindsight {
namespace {

constexpr int kNavigationDim = 9;

/// Zero of the coordinates that are counted additively: NED components at the
/// state for position, velocity and attitude, values for the rest.
State AdditiveZero(const State& reference, const Eigen::Vector3d& origin_e) {
  State zero = reference;
  zero.p_e = origin_e;
  zero.v_e.setZero();
  zero.b_g.setZero();
  zero.b_a.setZero();
  zero.parameters.setZero();
  return zero;
}

/// Rotation of C_nb = Rz(heading) Ry(pitch) Rx(roll) in n per Euler angle.
Eigen::Matrix3d RotationPerEuler(const Eigen::Vector3d& euler) {
  Eigen::Matrix3d M;
  M.col(0) =
      QuaternionFromEuler(0.0, euler.y(), euler.z()) * Eigen::Vector3d::UnitX();
  M.col(1) =
      QuaternionFromEuler(0.0, 0.0, euler.z()) * Eigen::Vector3d::UnitY();
  M.col(2) = Eigen::Vector3d::UnitZ();
  return M;
}

}  // namespace

Chart::Chart(const ErrorLayout& layout, ChartKind kind, const State& reference,
             const Eigen::Vector3d& origin_e)
    : layout_(&layout), kind_(kind), reference_(reference) {
  if (!layout.has_canonical_head()) {
    throw std::logic_error(
        "a chart needs complete position, velocity, attitude and bias blocks");
  }
  if (kind == ChartKind::kEuler) {
    xi_reference_ = EulerCoordinates(reference);
  } else {
    // -Local from the reference, so that the axes are those at the reference.
    xi_reference_ =
        -Local(layout, reference, AdditiveZero(reference, origin_e));
  }
}

ErrorVector Chart::EulerCoordinates(const State& x) const {
  // Biases and parameters are the difference to a state where they are zero.
  ErrorVector xi = -Local(*layout_, x, AdditiveZero(x, x.p_e));
  const Geodetic g = GeodeticFromEcef(x.p_e);
  xi.segment<3>(0) = Eigen::Vector3d(g.latitude, g.longitude, g.height);
  xi.segment<3>(3) = x.v_n();
  xi.segment<3>(6) = x.euler();
  return xi;
}

ErrorVector Chart::Coordinates(const State& x) const {
  if (kind_ == ChartKind::kAdditive) {
    return xi_reference_ + Local(*layout_, reference_, x);
  }
  ErrorVector xi = EulerCoordinates(x);
  for (const int angle : {1, 6, 8}) {
    xi(angle) =
        xi_reference_(angle) + WrapAngle(xi(angle) - xi_reference_(angle));
  }
  return xi;
}

ErrorMatrix Chart::Jacobian(const State& x) const {
  if (kind_ == ChartKind::kEuler) return EulerJacobian(x);
  const int n = layout_->dim();
  ErrorMatrix J = ErrorMatrix::Identity(n, n);
  const Eigen::Matrix<double, kNavigationDim, kNavigationDim> T =
      Transport(*layout_, reference_, x)
          .topLeftCorner<kNavigationDim, kNavigationDim>();
  J.topLeftCorner<kNavigationDim, kNavigationDim>() = T.inverse();
  return J;
}

ErrorMatrix Chart::EulerJacobian(const State& x) const {
  const int n = layout_->dim();
  const Geodetic g = GeodeticFromEcef(x.p_e);
  const double r_north = MeridianRadius(g.latitude) + g.height;
  const double r_east = TransverseRadius(g.latitude) + g.height;
  // Turn of the NED axes per displacement, in n: the dtheta that leads from
  // psi- to phi-angles.
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
  turn(0, 1) = 1.0 / r_east;
  turn(1, 0) = -1.0 / r_north;
  turn(2, 1) = -std::tan(g.latitude) / r_east;
  const Eigen::Matrix3d to_euler = RotationPerEuler(x.euler()).inverse();

  ErrorMatrix J = ErrorMatrix::Identity(n, n);
  J.block<3, 3>(0, 0) =
      Eigen::Vector3d(1.0 / r_north, 1.0 / (r_east * std::cos(g.latitude)),
                      -1.0)
          .asDiagonal();
  J.block<3, 3>(3, 0) = Skew(x.v_n()) * turn;
  J.block<3, 3>(6, 0) = -to_euler * turn;
  J.block<3, 3>(6, 6) = to_euler;
  return J;
}

State Chart::ToState(const ErrorVector& xi) const {
  if (kind_ == ChartKind::kAdditive) {
    return Retract(*layout_, reference_, xi - xi_reference_);
  }
  State x = MakeState(reference_.t, {xi(0), xi(1), xi(2)}, xi.segment<3>(3),
                      xi.segment<3>(6));
  x.b_g = reference_.b_g;
  x.b_a = reference_.b_a;
  x.parameters = reference_.parameters;
  ErrorVector rest = xi - xi_reference_;
  rest.head<kNavigationDim>().setZero();
  return Retract(*layout_, x, rest);
}

}  // namespace hindsight
