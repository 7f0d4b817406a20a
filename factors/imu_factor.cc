#include "factors/imu_factor.h"

namespace hindsight {
namespace {

bool IsImuBlock(BlockKind kind) {
  return kind == BlockKind::kGyroBias || kind == BlockKind::kAccelBias ||
         kind == BlockKind::kGyroScale || kind == BlockKind::kAccelScale;
}

/// Constants of the IMU and of the odometers that count distance.
std::vector<int> LinkGlobals(const StateBlocks& blocks) {
  std::vector<int> globals;
  for (const StateBlocks::Entry& entry : blocks.globals()) {
    const BlockKey& key = entry.block.key;
    if (IsImuBlock(key.kind) ||
        blocks.layout().Has(BlockKind::kDistance, key.sensor)) {
      globals.push_back(entry.ambient);
    }
  }
  return globals;
}

/// Row of the link's bias defect in the 15-row residual.
int LinkRow(BlockKind kind) { return kind == BlockKind::kGyroBias ? 9 : 12; }

bool IsBias(BlockKind kind) {
  return kind == BlockKind::kGyroBias || kind == BlockKind::kAccelBias;
}

/// Covariance of all rows of the factor.
Eigen::MatrixXd FactorNoise(const StateBlocks& blocks,
                            const NodeInterval& interval, double distance) {
  const ImuLink::Matrix15 S15 = LinkNoise(interval);
  Eigen::MatrixXd S =
      Eigen::MatrixXd::Zero(blocks.node_dim(), blocks.node_dim());
  S.topLeftCorner<9, 9>() = S15.topLeftCorner<9, 9>();
  for (const StateBlocks::Entry& entry : blocks.entries()) {
    if (entry.global || entry.tangent < 9) continue;
    const int dim = FullDimension(entry.block.key.kind);
    auto diagonal = S.diagonal().segment(entry.tangent, dim);
    if (IsBias(entry.block.key.kind)) {
      const int row = LinkRow(entry.block.key.kind);
      diagonal = S15.diagonal().segment<3>(row);
      S.block<9, 3>(0, entry.tangent) = S15.block<9, 3>(0, row);
      S.block<3, 9>(entry.tangent, 0) = S15.block<3, 9>(row, 0);
    } else if (entry.block.key.kind == BlockKind::kDistance) {
      diagonal.setConstant(kDistanceFloor * kDistanceFloor);
    } else {
      const BlockStep step = StepOf(interval, entry.block, distance);
      for (int axis = 0; axis < dim; ++axis) {
        diagonal(axis) = step.VarianceOf(axis);
      }
    }
  }
  return S;
}

}  // namespace

ImuFactor::ImuFactor(const StateBlocks* blocks, const Timeline* timeline, int k,
                     double distance)
    : TangentFactor(blocks, blocks->node_dim(), {k, k + 1},
                    LinkGlobals(*blocks)),
      timeline_(*timeline),
      k_(static_cast<std::size_t>(k)),
      summary_(timeline->SharedSummary(k_)),
      distance_(distance) {}

Eigen::MatrixXd ImuFactor::OwnWhitener() const {
  return Whitener(FactorNoise(blocks(), interval(), distance_));
}

void ImuFactor::Keep() {
  if (!whitener_) whitener_ = PackedTriangle(OwnWhitener());
}

void ImuFactor::LinearizeDistance(const StateBlocks::Entry& entry,
                                  const std::vector<State>& states,
                                  Eigen::Map<Eigen::VectorXd> residual,
                                  Jacobian* J) const {
  const Block& distance = entry.block;
  const DistanceLink link =
      EvaluateDistanceLink(blocks().layout(), timeline_, k_, states[0],
                           states[1], distance.key.sensor);
  const int row = entry.tangent;
  residual(row) =
      states[1].parameters(distance.parameter_offset) - link.distance;
  if (J == nullptr) return;
  for (const StateBlocks::Entry& other : blocks().entries()) {
    const Block& block = other.block;
    const int at_i = ColumnOf(other, 0);
    if (at_i >= 0) {
      J->block(row, at_i, 1, block.dim) -=
          link.J_i.segment(block.offset, block.dim);
    }
    if (other.global) continue;
    J->block(row, ColumnOf(other, 1), 1, block.dim) -=
        link.J_j.segment(block.offset, block.dim);
  }
  (*J)(row, blocks().node_dim() + row) += 1.0;
}

void ImuFactor::LinearizeRate(const StateBlocks::Entry& entry,
                              const BlockStep& step,
                              const std::vector<State>& states,
                              Eigen::Map<Eigen::VectorXd> residual,
                              Jacobian* J) const {
  if (!step.rate) return;
  const int dim = FullDimension(step.key.kind);
  const double by = step.rate_share * summary_->dt();
  for (const StateBlocks::Entry& other : blocks().entries()) {
    if (!(other.block.key == *step.rate)) continue;
    residual.segment(entry.tangent, dim) -=
        by * states[0].parameters.segment(other.block.parameter_offset, dim);
    if (J == nullptr) continue;
    J->block(entry.tangent, ColumnOf(other, 0), dim, dim)
        .diagonal()
        .setConstant(-by);
  }
}

void ImuFactor::LinearizeStates(const std::vector<State>& states,
                                Eigen::Map<Eigen::VectorXd> residual,
                                Jacobian* J) const {
  const StateBlocks& b = blocks();
  ImuLink link;
  EvaluateLink(b.layout(), *summary_, states[0], states[1], J != nullptr,
               &link);
  residual.head<9>() = link.residual.head<9>();
  if (J != nullptr) {
    J->block<9, 9>(0, 0) = link.J_i.topLeftCorner<9, 9>();
    J->block<9, 9>(0, b.node_dim()) = link.J_j.topLeftCorner<9, 9>();
  }
  for (const StateBlocks::Entry& entry : b.entries()) {
    const BlockKind kind = entry.block.key.kind;
    if (!entry.global && entry.tangent < 9) continue;
    if (J != nullptr && IsImuBlock(kind)) {
      const int column = ColumnOf(entry, 0);
      if (IsBias(kind)) {
        J->block<9, 3>(0, column) = link.J_i.block<9, 3>(0, LinkRow(kind));
      } else {
        J->block<9, 3>(0, column) =
            link.J_s.block<9, 3>(0, kind == BlockKind::kGyroScale ? 0 : 3);
      }
    }
    if (entry.global) continue;
    if (kind == BlockKind::kDistance) {
      LinearizeDistance(entry, states, residual, J);
      continue;
    }
    const int dim = FullDimension(kind);
    const BlockStep step = StepOf(interval(), entry.block, distance_);
    const double phi = step.phi;
    if (IsBias(kind)) {
      residual.segment<3>(entry.tangent) =
          link.residual.segment<3>(LinkRow(kind));
    } else {
      const int offset = entry.block.parameter_offset;
      residual.segment(entry.tangent, dim) =
          states[1].parameters.segment(offset, dim) -
          phi * states[0].parameters.segment(offset, dim);
    }
    LinearizeRate(entry, step, states, residual, J);
    if (J == nullptr) continue;
    for (int i = 0; i < dim; ++i) {
      const int row = entry.tangent + i;
      (*J)(row, row) = -phi;
      (*J)(row, b.node_dim() + row) = 1.0;
    }
  }
  Whiten(whitener_ ? *whitener_ : PackedTriangle(OwnWhitener()), residual, J);
}

}  // namespace hindsight
