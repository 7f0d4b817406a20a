#include "timeline/distance_link.h"

#include <cmath>

#include "geometry/so3.h"

namespace hindsight {
namespace {

/// d (Jl(phi)^-1 b) / d phi, from
///   Jl^-1 b = b - phi x b / 2 + c phi x (phi x b),
///   c = (1 - theta/2 cot(theta/2)) / theta^2.
Eigen::Matrix3d DerivativeOfLeftInverse(const Eigen::Vector3d& phi,
                                        const Eigen::Vector3d& b) {
  const double theta2 = phi.squaredNorm();
  double c = 1.0 / 12.0 + theta2 / 720.0 + theta2 * theta2 / 30240.0;
  double dc = 1.0 / 360.0 + theta2 / 7560.0;  // c'(theta) / theta
  constexpr double kSmall = 0.01;
  if (theta2 > kSmall) {
    const double theta = std::sqrt(theta2);
    const double half_cot = 0.5 / std::tan(0.5 * theta);
    c = (1.0 - theta * half_cot) / theta2;
    const double sine = std::sin(0.5 * theta);
    const double slope =
        (-half_cot + 0.25 * theta / (sine * sine)) / theta2 - 2.0 * c / theta;
    dc = slope / theta;
  }
  const Eigen::Vector3d twice = phi.cross(phi.cross(b));
  Eigen::Matrix3d D = 0.5 * Skew(b);
  D += c * (phi.dot(b) * Eigen::Matrix3d::Identity() + phi * b.transpose() -
            2.0 * b * phi.transpose());
  D += dc * twice * phi.transpose();
  return D;
}

/// D0 of a new increment and its derivatives at x_i.
void StartIncrement(const ErrorLayout& layout, const State& x_i,
                    const IncrementStart& start, DistanceLink* link) {
  const int sensor = start.sensor;
  link->distance = -Parameter1(layout, x_i, BlockKind::kOffset, sensor, 0.0);
  layout.AddColumns(BlockKind::kOffset, sensor,
                    Eigen::Matrix<double, 1, 1>(-1.0), &link->J_i);
  if (!start.offset_rate) return;
  const Block& offset = *layout.Find(BlockKind::kTimeOffset, sensor);
  const double dt =
      start.stamp + x_i.parameters(offset.parameter_offset) - x_i.t;
  link->distance -= dt * *start.offset_rate;
  link->J_i(offset.offset) = -*start.offset_rate;
}

}  // namespace

DistanceLink EvaluateDistanceLink(const ErrorLayout& layout,
                                  const Timeline& timeline, std::size_t k,
                                  const State& x_i, const State& x_j,
                                  int sensor) {
  DistanceLink link;
  link.J_i.setZero(layout.dim());
  link.J_j.setZero(layout.dim());
  constexpr double kSameInstant = 1e-9;
  const IncrementStart* start = timeline.IncrementStartAt(k, sensor);
  if (start != nullptr && x_i.t < timeline.node(k).t + kSameInstant) {
    StartIncrement(layout, x_i, *start, &link);
  } else {
    link.distance = Parameter1(layout, x_i, BlockKind::kDistance, sensor, 0.0);
    layout.AddColumns(BlockKind::kDistance, sensor,
                      Eigen::Matrix<double, 1, 1>(1.0), &link.J_i);
  }
  const Sensor& odometer = timeline.sensors()[static_cast<std::size_t>(sensor)];
  const Eigen::Vector3d l = Parameter3(layout, x_i, BlockKind::kLeverArm,
                                       sensor, odometer.lever_arm_b);
  const Eigen::Vector3d m = Parameter3(layout, x_i, BlockKind::kMounting,
                                       sensor, Eigen::Vector3d::Zero());
  const double scale =
      1.0 + Parameter1(layout, x_i, BlockKind::kScale, sensor, odometer.scale);
  const Eigen::Matrix3d C_ob = (Exp(m) * odometer.q_sb).toRotationMatrix();
  const Eigen::Matrix3d C_i = x_i.q_eb.toRotationMatrix();
  const Eigen::Matrix3d C_j = x_j.q_eb.toRotationMatrix();
  const Eigen::Vector3d lever = C_j * l - C_i * l;
  const Eigen::Vector3d dP = x_j.p_e - x_i.p_e + lever;
  const Eigen::Vector3d phi = Log(x_i.q_eb.conjugate() * x_j.q_eb);
  const Eigen::Vector3d b = C_i.transpose() * dP;
  const Eigen::Matrix3d J_inverse = LeftJacobianInverse(phi);
  const Eigen::Vector3d s_o = C_ob * J_inverse * b;
  link.distance += scale * s_o.x();

  // Of a rotation theta_i in e of C_i, and so of j.
  const Eigen::RowVector3d A = scale * C_ob.row(0);
  const Eigen::RowVector3d A_e = A * J_inverse * C_i.transpose();
  const Eigen::RowVector3d turn = A * DerivativeOfLeftInverse(phi, b) *
                                  RightJacobianInverse(phi) * C_j.transpose();
  const int none = BlockKey::kNoSensor;
  const Eigen::Matrix3d C_en_i = x_i.C_en();
  const Eigen::Matrix3d C_en_j = x_j.C_en();
  layout.AddColumns(BlockKind::kPosition, none, -A_e * C_en_i, &link.J_i);
  layout.AddColumns(BlockKind::kPosition, none, A_e * C_en_j, &link.J_j);
  layout.AddColumns(BlockKind::kAttitude, none,
                    (A_e * Skew(dP + C_i * l) - turn) * C_en_i, &link.J_i);
  layout.AddColumns(BlockKind::kAttitude, none,
                    (turn - A_e * Skew(C_j * l)) * C_en_j, &link.J_j);
  layout.AddColumns(BlockKind::kLeverArm, sensor, A_e * (C_j - C_i), &link.J_i);
  layout.AddColumns(BlockKind::kMounting, sensor,
                    -scale * Skew(s_o).row(0) * LeftJacobian(m), &link.J_i);
  layout.AddColumns(BlockKind::kScale, sensor,
                    Eigen::Matrix<double, 1, 1>(s_o.x()), &link.J_i);
  return link;
}

void PredictDistances(const ErrorLayout& layout, const Timeline& timeline,
                      std::size_t k, const State& x_i, State* x_j) {
  for (const Block& block : layout.blocks()) {
    if (block.key.kind != BlockKind::kDistance) continue;
    x_j->parameters(block.parameter_offset) =
        EvaluateDistanceLink(layout, timeline, k, x_i, *x_j, block.key.sensor)
            .distance;
  }
}

void LinearizeDistances(const ErrorLayout& layout, const Timeline& timeline,
                        std::size_t k, const State& x_i, const State& x_j,
                        Transition* transition) {
  for (const Block& block : layout.blocks()) {
    if (block.key.kind != BlockKind::kDistance) continue;
    const int row = block.offset;
    const DistanceLink link =
        EvaluateDistanceLink(layout, timeline, k, x_i, x_j, block.key.sensor);
    // d_D = J_i d_i + J_j d_j + c, and d_j follows d_i.
    transition->Phi.row(row) = link.J_i + link.J_j * transition->Phi;
    transition->c(row) = link.distance -
                         x_j.parameters(block.parameter_offset) +
                         link.J_j.dot(transition->c);
    const ErrorVector QJ = transition->Q * link.J_j.transpose();
    transition->Q.row(row) = QJ.transpose();
    transition->Q.col(row) = QJ;
    transition->Q(row, row) =
        link.J_j.dot(QJ) + kDistanceFloor * kDistanceFloor;
  }
}

}  // namespace hindsight
