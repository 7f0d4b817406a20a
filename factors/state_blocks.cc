#include "factors/state_blocks.h"

#include <stdexcept>

#include "geometry/so3.h"

namespace hindsight {
namespace {

constexpr int kPosition = 0;
constexpr int kVelocity = 3;
constexpr int kQuaternion = 6;
constexpr int kAdditive = 10;
constexpr int kRotationDim = 9;  // tangent of position, velocity, attitude

using RowMajorMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using ConstVector3 = Eigen::Map<const Eigen::Vector3d>;
using ConstQuaternion = Eigen::Map<const Eigen::Quaterniond>;

/// d Log(q' q^-1) / d q' at q' = q: the left inverse of LeftPlusJacobian.
Eigen::Matrix<double, 3, 4> LeftMinusJacobian(const Eigen::Quaterniond& q) {
  return 4.0 * LeftPlusJacobian(q).transpose();
}

}  // namespace

StateBlocks::StateBlocks(const ErrorLayout& layout) : layout_(layout) {
  const auto& blocks = layout.blocks();
  if (blocks.size() < 3 || blocks[0].key.kind != BlockKind::kPosition ||
      blocks[1].key.kind != BlockKind::kVelocity ||
      blocks[2].key.kind != BlockKind::kAttitude) {
    throw std::logic_error(
        "a whole-interval problem needs position, velocity and attitude first");
  }
  node_ambient_dim_ = kAdditive;
  for (const Block& block : blocks) {
    const int dim = FullDimension(block.key.kind);
    if (block.dim != dim) {
      throw std::logic_error("block '" + block.name + "' has masked axes");
    }
    Entry entry;
    entry.block = block;
    entry.global = block.evolution.is_constant();
    if (entry.global) {
      entry.ambient = static_cast<int>(globals_.size());
      entry.tangent = global_dim_;
      global_dim_ += dim;
      globals_.push_back(entry);
    } else {
      entry.tangent = node_dim_;
      node_dim_ += dim;
      if (node_dim_ > kRotationDim) {
        entry.ambient = node_ambient_dim_;
        node_ambient_dim_ += dim;
      }
    }
    entries_.push_back(entry);
  }
}

namespace {

void CopyOut(const State& x, const Block& block, double* out) {
  const int dim = FullDimension(block.key.kind);
  Eigen::Map<Eigen::VectorXd> values(out, dim);
  if (block.key.kind == BlockKind::kGyroBias) {
    values = x.b_g;
  } else if (block.key.kind == BlockKind::kAccelBias) {
    values = x.b_a;
  } else {
    values = x.parameters.segment(block.parameter_offset, dim);
  }
}

void CopyIn(const double* in, const Block& block, State* x) {
  const int dim = FullDimension(block.key.kind);
  const Eigen::Map<const Eigen::VectorXd> values(in, dim);
  if (block.key.kind == BlockKind::kGyroBias) {
    x->b_g = values;
  } else if (block.key.kind == BlockKind::kAccelBias) {
    x->b_a = values;
  } else {
    x->parameters.segment(block.parameter_offset, dim) = values;
  }
}

}  // namespace

void StateBlocks::WriteNode(const State& x, double* ambient) const {
  Eigen::Map<Eigen::Vector3d>(ambient + kPosition) = x.p_e;
  Eigen::Map<Eigen::Vector3d>(ambient + kVelocity) = x.v_e;
  Eigen::Map<Eigen::Quaterniond>(ambient + kQuaternion) = x.q_eb;
  for (const Entry& entry : entries_) {
    if (!entry.global && entry.tangent >= kRotationDim) {
      CopyOut(x, entry.block, ambient + entry.ambient);
    }
  }
}

void StateBlocks::WriteGlobal(const State& x, int g, double* values) const {
  CopyOut(x, globals_[static_cast<std::size_t>(g)].block, values);
}

State StateBlocks::ReadState(double t, const double* ambient,
                             const std::vector<const double*>& globals) const {
  State x;
  x.t = t;
  x.p_e = ConstVector3(ambient + kPosition);
  x.v_e = ConstVector3(ambient + kVelocity);
  x.q_eb = ConstQuaternion(ambient + kQuaternion);
  x.parameters.setZero(layout_.parameter_count());
  for (const Entry& entry : entries_) {
    if (entry.global) {
      const double* values = globals[static_cast<std::size_t>(entry.ambient)];
      if (values != nullptr) CopyIn(values, entry.block, &x);
    } else if (entry.tangent >= kRotationDim) {
      CopyIn(ambient + entry.ambient, entry.block, &x);
    }
  }
  return x;
}

bool NodeManifold::Plus(const double* x, const double* delta,
                        double* x_plus_delta) const {
  const Eigen::Matrix3d C_en = NedAxes(ConstVector3(x + kPosition));
  Eigen::Map<Eigen::Vector3d>(x_plus_delta + kPosition) =
      ConstVector3(x + kPosition) + C_en * ConstVector3(delta);
  Eigen::Map<Eigen::Vector3d>(x_plus_delta + kVelocity) =
      ConstVector3(x + kVelocity) + C_en * ConstVector3(delta + 3);
  const Eigen::Vector3d phi = C_en * ConstVector3(delta + 6);
  Eigen::Map<Eigen::Quaterniond>(x_plus_delta + kQuaternion) =
      (Exp(phi) * ConstQuaternion(x + kQuaternion)).normalized();
  for (int i = 0; i < AmbientSize() - kAdditive; ++i) {
    x_plus_delta[kAdditive + i] = x[kAdditive + i] + delta[kRotationDim + i];
  }
  return true;
}

bool NodeManifold::PlusJacobian(const double* x, double* jacobian) const {
  Eigen::Map<RowMajorMatrix> J(jacobian, AmbientSize(), TangentSize());
  const Eigen::Matrix3d C_en = NedAxes(ConstVector3(x + kPosition));
  J.setZero();
  J.block<3, 3>(kPosition, 0) = C_en;
  J.block<3, 3>(kVelocity, 3) = C_en;
  J.block<4, 3>(kQuaternion, 6) =
      LeftPlusJacobian(ConstQuaternion(x + kQuaternion)) * C_en;
  J.bottomRightCorner(AmbientSize() - kAdditive, AmbientSize() - kAdditive)
      .setIdentity();
  return true;
}

bool NodeManifold::Minus(const double* y, const double* x,
                         double* y_minus_x) const {
  const Eigen::Matrix3d C_ne = NedAxes(ConstVector3(x + kPosition)).transpose();
  Eigen::Map<Eigen::Vector3d> d(y_minus_x);
  d = C_ne * (ConstVector3(y + kPosition) - ConstVector3(x + kPosition));
  Eigen::Map<Eigen::Vector3d>(y_minus_x + 3) =
      C_ne * (ConstVector3(y + kVelocity) - ConstVector3(x + kVelocity));
  Eigen::Map<Eigen::Vector3d>(y_minus_x + 6) =
      C_ne * Log(ConstQuaternion(y + kQuaternion) *
                 ConstQuaternion(x + kQuaternion).conjugate());
  for (int i = 0; i < AmbientSize() - kAdditive; ++i) {
    y_minus_x[kRotationDim + i] = y[kAdditive + i] - x[kAdditive + i];
  }
  return true;
}

bool NodeManifold::MinusJacobian(const double* x, double* jacobian) const {
  Eigen::Map<RowMajorMatrix> J(jacobian, TangentSize(), AmbientSize());
  const Eigen::Matrix3d C_ne = NedAxes(ConstVector3(x + kPosition)).transpose();
  J.setZero();
  J.block<3, 3>(0, kPosition) = C_ne;
  J.block<3, 3>(3, kVelocity) = C_ne;
  J.block<3, 4>(6, kQuaternion) =
      C_ne * LeftMinusJacobian(ConstQuaternion(x + kQuaternion));
  J.bottomRightCorner(AmbientSize() - kAdditive, AmbientSize() - kAdditive)
      .setIdentity();
  return true;
}

}  // namespace hindsight
