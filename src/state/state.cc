#include "state/state.h"

#include "state/active_axes.h"

namespace hindsight {

State MakeState(double t, const Geodetic& position, const Eigen::Vector3d& v_n,
                const Eigen::Vector3d& euler) {
  State x;
  x.t = t;
  x.p_e = EcefFromGeodetic(position);
  const Eigen::Matrix3d C_en = NedAxes(position.latitude, position.longitude);
  x.v_e = C_en * v_n;
  x.q_eb = Eigen::Quaterniond(C_en) *
           QuaternionFromEuler(euler.x(), euler.y(), euler.z());
  x.q_eb.normalize();
  return x;
}

Eigen::Vector3d Parameter3(const ErrorLayout& layout, const State& x,
                           BlockKind kind, int sensor,
                           const Eigen::Vector3d& fallback) {
  const Block* block = layout.Find(kind, sensor);
  if (block == nullptr) return fallback;
  return x.parameters.segment<3>(block->parameter_offset);
}

double Parameter1(const ErrorLayout& layout, const State& x, BlockKind kind,
                  int sensor, double fallback) {
  const Block* block = layout.Find(kind, sensor);
  return block == nullptr ? fallback : x.parameters(block->parameter_offset);
}

State Retract(const ErrorLayout& layout, const State& x, const ErrorVector& d) {
  State y = x;
  const Eigen::Matrix3d C_en = x.C_en();
  for (const Block& block : layout.blocks()) {
    const Eigen::Vector3d full = Expand(block, d);
    switch (block.key.kind) {
      case BlockKind::kPosition:
        y.p_e += C_en * full;
        break;
      case BlockKind::kVelocity:
        y.v_e += C_en * full;
        break;
      case BlockKind::kAttitude:
        y.q_eb = (Exp(C_en * full) * x.q_eb).normalized();
        break;
      case BlockKind::kGyroBias:
        y.b_g += full;
        break;
      case BlockKind::kAccelBias:
        y.b_a += full;
        break;
      default:
        y.parameters.segment(block.parameter_offset,
                             FullDimension(block.key.kind)) +=
            full.head(FullDimension(block.key.kind));
    }
  }
  return y;
}

ErrorVector Local(const ErrorLayout& layout, const State& reference,
                  const State& x) {
  ErrorVector d(layout.dim());
  const Eigen::Matrix3d C_ne = reference.C_en().transpose();
  for (const Block& block : layout.blocks()) {
    Eigen::Vector3d full = Eigen::Vector3d::Zero();
    switch (block.key.kind) {
      case BlockKind::kPosition:
        full = C_ne * (x.p_e - reference.p_e);
        break;
      case BlockKind::kVelocity:
        full = C_ne * (x.v_e - reference.v_e);
        break;
      case BlockKind::kAttitude:
        full = C_ne * Log(x.q_eb * reference.q_eb.conjugate());
        break;
      case BlockKind::kGyroBias:
        full = x.b_g - reference.b_g;
        break;
      case BlockKind::kAccelBias:
        full = x.b_a - reference.b_a;
        break;
      default: {
        const int n = FullDimension(block.key.kind);
        full.head(n) = x.parameters.segment(block.parameter_offset, n) -
                       reference.parameters.segment(block.parameter_offset, n);
      }
    }
    Compress(block, full, &d);
  }
  return d;
}

ErrorMatrix Transport(const ErrorLayout& layout, const State& from,
                      const State& to) {
  ErrorMatrix T = ErrorMatrix::Identity(layout.dim(), layout.dim());
  const Eigen::Matrix3d C_en_from = from.C_en();
  const Eigen::Matrix3d C_ne_to = to.C_en().transpose();
  const Eigen::Matrix3d axes = C_ne_to * C_en_from;
  const auto assign = [&](const Block& block, const Eigen::Matrix3d& full) {
    int row = block.offset;
    for (int i = 0; i < 3; ++i) {
      if (!block.active[static_cast<std::size_t>(i)]) continue;
      int column = block.offset;
      for (int j = 0; j < 3; ++j) {
        if (!block.active[static_cast<std::size_t>(j)]) continue;
        T(row, column++) = full(i, j);
      }
      ++row;
    }
  };
  for (const Block& block : layout.blocks()) {
    if (block.key.kind == BlockKind::kPosition ||
        block.key.kind == BlockKind::kVelocity) {
      assign(block, axes);
    } else if (block.key.kind == BlockKind::kAttitude) {
      // Exp(C psi) q_from against q_to = Exp(a) q_from: to first order about
      // C psi = a the remaining rotation is Jl(a) C d psi.
      const Eigen::Vector3d a = Log(to.q_eb * from.q_eb.conjugate());
      assign(block, C_ne_to * LeftJacobian(a) * C_en_from);
    }
  }
  return T;
}

}  // namespace hindsight
