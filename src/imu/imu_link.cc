#include "imu/imu_link.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "earth/wgs84.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

constexpr int kP = 0;
constexpr int kV = 3;
constexpr int kR = 6;
constexpr int kBg = 9;
constexpr int kBa = 12;

/// E(dt) = Exp(w_ie dt): inertial axes at t_i from e at t_j.
Eigen::Matrix3d EarthRotation(double dt) {
  const double angle = kEarthRate * dt;
  const double s = std::sin(angle);
  const double c = std::cos(angle);
  Eigen::Matrix3d E;
  E << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
  return E;
}

Eigen::Vector3d EarthRateCross(const Eigen::Vector3d& v) {
  return {-kEarthRate * v.y(), kEarthRate * v.x(), 0.0};
}

}  // namespace

ImuCalibration CalibrationOf(const ErrorLayout& layout, const State& x) {
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  return {
      x.b_g, x.b_a,
      Parameter3(layout, x, BlockKind::kGyroScale, BlockKey::kNoSensor, none),
      Parameter3(layout, x, BlockKind::kAccelScale, BlockKey::kNoSensor, none)};
}

double Travelled(const State& x, double dt) {
  constexpr double kLeastSpeed = 0.01;
  return std::max(x.v_e.norm(), kLeastSpeed) * dt;
}

State Predict(const ErrorLayout& layout, const State& x_i,
              const ImuSummary& summary) {
  const double dt = summary.dt();
  const CorrectedMean mean = Correct(summary, CalibrationOf(layout, x_i));
  const Eigen::Matrix3d R_i = x_i.q_eb.toRotationMatrix();
  const Eigen::Matrix3d E = EarthRotation(dt);
  const Eigen::Vector3d V_i = x_i.v_e + EarthRateCross(x_i.p_e);
  const Eigen::Vector3d g_i = Gravitation(x_i.p_e);
  const Eigen::Vector3d inertial = x_i.p_e + dt * V_i + R_i * mean.dp;

  Eigen::Vector3d g_j = g_i;
  Eigen::Vector3d P_j = inertial + (0.5 * dt * dt) * g_i;
  // Gravitation at the end depends on the end; two passes leave 1e-12 m.
  for (int pass = 0; pass < 2; ++pass) {
    g_j = E * Gravitation(E.transpose() * P_j);
    P_j = inertial + (dt * dt) * (g_i / 3.0 + g_j / 6.0);
  }
  const Eigen::Vector3d V_j = V_i + R_i * mean.dv + (0.5 * dt) * (g_i + g_j);

  State x = x_i;
  x.t = summary.t_j;
  x.p_e = E.transpose() * P_j;
  x.v_e = E.transpose() * V_j - EarthRateCross(x.p_e);
  x.q_eb =
      (Eigen::Quaterniond(E.transpose()) * x_i.q_eb * mean.dR).normalized();
  x.b_g *= summary.gyro_bias_phi;
  x.b_a *= summary.accel_bias_phi;
  PredictParameters(layout, x_i, dt, &x);
  return x;
}

void PredictParameters(const ErrorLayout& layout, const State& x_i, double dt,
                       State* x_j) {
  for (const Block& block : layout.blocks()) {
    if (block.parameter_offset < 0) continue;
    const int dim = FullDimension(block.key.kind);
    x_j->parameters.segment(block.parameter_offset, dim) =
        block.evolution.Phi(dt, Travelled(x_i, dt)) *
        x_i.parameters.segment(block.parameter_offset, dim);
  }
}

void EvaluateLink(const ErrorLayout& layout, const ImuSummary& summary,
                  const State& x_i, const State& x_j, bool jacobians,
                  ImuLink* out) {
  const double dt = summary.dt();
  const CorrectedMean mean = Correct(summary, CalibrationOf(layout, x_i));
  const Eigen::Matrix3d E = EarthRotation(dt);
  const Eigen::Matrix3d R_i = x_i.q_eb.toRotationMatrix();
  const Eigen::Vector3d V_i = x_i.v_e + EarthRateCross(x_i.p_e);
  const Eigen::Vector3d P_j = E * x_j.p_e;
  const Eigen::Vector3d V_j = E * (x_j.v_e + EarthRateCross(x_j.p_e));
  const Eigen::Vector3d g_i = Gravitation(x_i.p_e);
  const Eigen::Vector3d g_j = E * Gravitation(x_j.p_e);

  const Eigen::Vector3d a_p =
      P_j - x_i.p_e - dt * V_i - (dt * dt) * (g_i / 3.0 + g_j / 6.0);
  const Eigen::Vector3d a_v = V_j - V_i - (0.5 * dt) * (g_i + g_j);
  const Eigen::Quaterniond rotation =
      x_i.q_eb.conjugate() * Eigen::Quaterniond(E) * x_j.q_eb;
  const Eigen::Vector3d r_R = Log(mean.dR.conjugate() * rotation);
  out->residual << R_i.transpose() * a_p - mean.dp,
      R_i.transpose() * a_v - mean.dv, r_R,
      x_j.b_g - summary.gyro_bias_phi * x_i.b_g,
      x_j.b_a - summary.accel_bias_phi * x_i.b_a;
  if (!jacobians) return;

  const Eigen::Matrix3d C_en_i = x_i.C_en();
  const Eigen::Matrix3d C_en_j = x_j.C_en();
  const Eigen::Matrix3d A = R_i.transpose() * C_en_i;      // body i from n at i
  const Eigen::Matrix3d B = R_i.transpose() * E * C_en_j;  // body i from n at j
  const Eigen::Matrix3d W = Skew(EarthRate_e());
  const Eigen::Matrix3d RW_i = R_i.transpose() * W * C_en_i;
  const Eigen::Matrix3d RW_j = R_i.transpose() * E * W * C_en_j;
  const Eigen::Matrix3d G_i =
      R_i.transpose() * GravitationGradient(x_i.p_e) * C_en_i;
  const Eigen::Matrix3d G_j =
      R_i.transpose() * E * GravitationGradient(x_j.p_e) * C_en_j;
  const Eigen::Matrix3d Jr_inverse = RightJacobianInverse(r_R);

  auto& J_i = out->J_i;
  J_i.setZero();
  J_i.block<3, 3>(kP, kP) = -A - dt * RW_i - (dt * dt / 3.0) * G_i;
  J_i.block<3, 3>(kP, kV) = -dt * A;
  J_i.block<3, 3>(kP, kR) = R_i.transpose() * Skew(a_p) * C_en_i;
  J_i.block<3, 3>(kP, kBg) = -summary.p_bg;
  J_i.block<3, 3>(kP, kBa) = -summary.p_ba;
  J_i.block<3, 3>(kV, kP) = -RW_i - (0.5 * dt) * G_i;
  J_i.block<3, 3>(kV, kV) = -A;
  J_i.block<3, 3>(kV, kR) = R_i.transpose() * Skew(a_v) * C_en_i;
  J_i.block<3, 3>(kV, kBg) = -summary.v_bg;
  J_i.block<3, 3>(kV, kBa) = -summary.v_ba;
  J_i.block<3, 3>(kR, kR) =
      -Jr_inverse * rotation.conjugate().toRotationMatrix() * A;
  const Eigen::Matrix3d rotation_from_correction =
      -RightJacobianInverse(-r_R) * mean.dR.conjugate().toRotationMatrix() *
      LeftJacobian(mean.rotation_correction);
  J_i.block<3, 3>(kR, kBg) = rotation_from_correction * summary.R_bg;
  J_i.block<3, 3>(kBg, kBg).diagonal().setConstant(-summary.gyro_bias_phi);
  J_i.block<3, 3>(kBa, kBa).diagonal().setConstant(-summary.accel_bias_phi);

  auto& J_j = out->J_j;
  J_j.setZero();
  J_j.block<3, 3>(kP, kP) = B - (dt * dt / 6.0) * G_j;
  J_j.block<3, 3>(kV, kP) = RW_j - (0.5 * dt) * G_j;
  J_j.block<3, 3>(kV, kV) = B;
  J_j.block<3, 3>(kR, kR) =
      Jr_inverse * x_j.q_eb.conjugate().toRotationMatrix() * C_en_j;
  J_j.block<6, 6>(kBg, kBg).setIdentity();

  auto& J_s = out->J_s;
  J_s.setZero();
  J_s.block<3, 3>(kP, 0) = -summary.p_sg;
  J_s.block<3, 3>(kP, 3) = -summary.p_sa;
  J_s.block<3, 3>(kV, 0) = -summary.v_sg;
  J_s.block<3, 3>(kV, 3) = -summary.v_sa;
  J_s.block<3, 3>(kR, 0) = rotation_from_correction * summary.R_sg;
}

ImuLink::Matrix15 LinkNoise(const ImuSummary& summary) {
  constexpr double kLeastPosition = 1e-6 * 1e-6;
  constexpr double kVelocityFloor = 1e-9 * 1e-9;
  constexpr double kRotationFloor = 1e-12 * 1e-12;
  ImuLink::Matrix15 S;
  S.topLeftCorner<9, 9>() = summary.noise;
  for (int row = kP; row < kP + 3; ++row) {
    S(row, row) = std::max(S(row, row), kLeastPosition);
  }
  S.diagonal().segment<3>(kV).array() += kVelocityFloor;
  S.diagonal().segment<3>(kR).array() += kRotationFloor;
  S.topRightCorner<9, 6>() = summary.bias_cross;
  S.bottomLeftCorner<6, 9>() = summary.bias_cross.transpose();
  S.bottomRightCorner<6, 6>().setZero();
  S.diagonal().segment<3>(kBg).setConstant(summary.gyro_bias_variance);
  S.diagonal().segment<3>(kBa).setConstant(summary.accel_bias_variance);
  return S;
}

namespace {

/// J_j^-1 of the 9 navigation rows: block lower triangular in position,
/// velocity; attitude stands apart.
Eigen::Matrix<double, 9, 9> InverseAtEnd(const ImuLink& link) {
  Eigen::Matrix<double, 9, 9> inverse = Eigen::Matrix<double, 9, 9>::Zero();
  const Eigen::Matrix3d pp = link.J_j.block<3, 3>(kP, kP).inverse();
  const Eigen::Matrix3d vv = link.J_j.block<3, 3>(kV, kV).inverse();
  inverse.block<3, 3>(kP, kP) = pp;
  inverse.block<3, 3>(kV, kV) = vv;
  inverse.block<3, 3>(kV, kP) = -vv * link.J_j.block<3, 3>(kV, kP) * pp;
  inverse.block<3, 3>(kR, kR) = link.J_j.block<3, 3>(kR, kR).inverse();
  return inverse;
}

/// Component of the 15 navigation ones that each component of a layout is, and
/// the scale factor column (0-5) it is, or -1.
struct ComponentMap {
  std::array<int, kMaxErrorDim> navigation;
  std::array<int, kMaxErrorDim> scale;
};

ComponentMap MapComponents(const ErrorLayout& layout) {
  ComponentMap map;
  map.navigation.fill(-1);
  map.scale.fill(-1);
  for (const Block& block : layout.blocks()) {
    const int kind = static_cast<int>(block.key.kind);
    int component = block.offset;
    for (int axis = 0; axis < FullDimension(block.key.kind); ++axis) {
      if (!block.active[static_cast<std::size_t>(axis)]) continue;
      const auto c = static_cast<std::size_t>(component++);
      if (IsNavigation(block.key.kind)) {
        map.navigation[c] = 3 * kind + axis;
      } else if (block.key.kind == BlockKind::kGyroScale) {
        map.scale[c] = axis;
      } else if (block.key.kind == BlockKind::kAccelScale) {
        map.scale[c] = 3 + axis;
      }
    }
  }
  return map;
}

}  // namespace

void LinearizeTransition(const ErrorLayout& layout, const ImuSummary& summary,
                         const State& x_i, const State& x_j, Transition* out) {
  LinearizeTransition(layout, summary, LinkNoise(summary), x_i, x_j, out);
}

void LinearizeTransition(const ErrorLayout& layout, const ImuSummary& summary,
                         const ImuLink::Matrix15& S, const State& x_i,
                         const State& x_j, Transition* out) {
  ImuLink link;
  EvaluateLink(layout, summary, x_i, x_j, true, &link);
  const Eigen::Matrix<double, 9, 9> inverse = InverseAtEnd(link);
  ImuLink::Matrix15 Phi = ImuLink::Matrix15::Zero();
  Phi.topRows<9>().noalias() = -inverse * link.J_i.topRows<9>();
  Phi.bottomRightCorner<6, 6>() = -link.J_i.bottomRightCorner<6, 6>();
  ImuLink::Vector15 c = -link.residual;
  c.head<9>() = -inverse * link.residual.head<9>();
  ImuLink::Matrix15 Q = S;
  Q.topLeftCorner<9, 9>() =
      (inverse * Q.topLeftCorner<9, 9>() * inverse.transpose()).eval();
  Q.topRightCorner<9, 6>() = (inverse * Q.topRightCorner<9, 6>()).eval();
  Q.bottomLeftCorner<6, 9>() = Q.topRightCorner<9, 6>().transpose();

  const int n = layout.dim();
  if (n == 15 && layout.has_canonical_head()) {
    out->Phi = Phi;
    out->Q = Q;
    out->c = c;
    return;
  }
  const Eigen::Matrix<double, 9, 6> Phi_s = -inverse * link.J_s.topRows<9>();
  const ComponentMap map = MapComponents(layout);
  out->Phi.setZero(n, n);
  out->Q.setZero(n, n);
  out->c.setZero(n);
  for (int i = 0; i < n; ++i) {
    const int row = map.navigation[static_cast<std::size_t>(i)];
    if (row < 0) continue;
    out->c(i) = c(row);
    for (int j = 0; j < n; ++j) {
      const int column = map.navigation[static_cast<std::size_t>(j)];
      const int scale = map.scale[static_cast<std::size_t>(j)];
      if (column >= 0) {
        out->Phi(i, j) = Phi(row, column);
        out->Q(i, j) = Q(row, column);
      } else if (scale >= 0 && row < 9) {
        out->Phi(i, j) = Phi_s(row, scale);
      }
    }
  }
  const double dt = summary.dt();
  const double distance = Travelled(x_i, dt);
  for (const Block& block : layout.blocks()) {
    if (block.parameter_offset < 0) continue;
    const double phi = block.evolution.Phi(dt, distance);
    int component = block.offset;
    for (int axis = 0; axis < FullDimension(block.key.kind); ++axis) {
      if (!block.active[static_cast<std::size_t>(axis)]) continue;
      const int parameter = block.parameter_offset + axis;
      out->Phi(component, component) = phi;
      out->Q(component, component) = block.evolution.Q(dt, distance);
      out->c(component) =
          phi * x_i.parameters(parameter) - x_j.parameters(parameter);
      ++component;
    }
  }
}

}  // namespace hindsight
