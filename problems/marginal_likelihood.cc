#include "problems/marginal_likelihood.h"

#include <algorithm>

#include "alignment/alignment.h"
#include "filters/measurement_rule.h"

namespace hindsight {
namespace {

/// Puts independent errors of these sigmas into a block.
void WidenBlock(const ErrorLayout& layout, BlockKind kind,
                const Eigen::Vector3d& sigma, ErrorMatrix* P) {
  const Block* block = layout.Find(kind);
  if (block == nullptr) return;
  P->middleRows(block->offset, block->dim).setZero();
  P->middleCols(block->offset, block->dim).setZero();
  int row = block->offset;
  for (int axis = 0; axis < 3; ++axis) {
    if (!block->active[static_cast<std::size_t>(axis)]) continue;
    (*P)(row, row) = sigma(axis) * sigma(axis);
    ++row;
  }
}

}  // namespace

Prior PriorOfComparison(const Dataset& dataset, const Start& start,
                        const State& x) {
  constexpr double kAnyPosition = 100.0;
  constexpr double kAnyVelocity = 100.0;
  const InitialState& given = dataset.initial;
  Prior prior = start.prior;
  const auto widen = [&](BlockKind kind, const Eigen::Vector3d& sigma) {
    WidenBlock(start.layout, kind, sigma, &prior.P);
  };
  if (!given.position) {
    prior.x.p_e = x.p_e;
    widen(BlockKind::kPosition, Eigen::Vector3d::Constant(kAnyPosition));
  }
  if (!given.v_n) {
    prior.x.v_e = x.v_e;
    widen(BlockKind::kVelocity, Eigen::Vector3d::Constant(kAnyVelocity));
  }
  if (!given.euler && !given.heading) {
    prior.x.q_eb = x.q_eb;
    widen(BlockKind::kAttitude,
          Eigen::Vector3d::Constant(kUnknownHeadingSigma));
  }
  prior.x.b_g = given.gyro_bias;
  prior.x.b_a = given.accel_bias;
  widen(BlockKind::kGyroBias, GyroBiasSigma(given));
  widen(BlockKind::kAccelBias, AccelBiasSigma(given));
  for (const Block& block : start.layout.blocks()) {
    if (block.key.kind != BlockKind::kTimeOffset) continue;
    const AidingStream& stream =
        dataset.streams[static_cast<std::size_t>(block.key.sensor)];
    prior.x.parameters(block.parameter_offset) =
        stream.clock_unknown ? x.parameters(block.parameter_offset)
                             : stream.sensor.time_offset;
  }
  return prior;
}

MarginalLikelihood MarginalLikelihoodOf(const ErrorLayout& layout,
                                        const Prior& prior,
                                        const std::vector<State>& nominal,
                                        const GateDecisions& decisions,
                                        const GateDecisions& used,
                                        Timeline* timeline) {
  GateDecisions accepted = used;
  for (std::size_t i = 0; i < accepted.size(); ++i) {
    if (decisions[i] == 0) accepted[i] = 0;
  }
  const LinearTape tape =
      RunLinearizedFilter(layout, prior, nominal, timeline, accepted);
  MarginalLikelihood out;
  std::size_t i = 0;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    for (const TapeMeasurement& z : tape.measurements(k)) {
      const bool counts = used[i++] != 0 && !z.withheld;
      if (!counts) continue;
      const int rows = static_cast<int>(z.innovation.size());
      const auto sensor = static_cast<std::size_t>(z.sensor);
      const double nis =
          z.accepted
              ? z.nis
              : std::min(z.nis, GateLimit(timeline->sensors()[sensor], rows));
      out.log += z.log_likelihood + 0.5 * (z.nis - nis);
      out.squares += nis;
      out.rows += rows;
    }
  }
  return out;
}

}  // namespace hindsight
