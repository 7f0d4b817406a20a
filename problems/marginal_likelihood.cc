#include "problems/marginal_likelihood.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "alignment/alignment.h"
#include "dataset/bias_sigma.h"
#include "filters/forward_filter.h"
#include "filters/measurement_rule.h"
#include "filters/tape_adjoint.h"

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

/// Q of an interval with the IMU's noise alone.
ErrorMatrix IntervalNoise(const LinearTape& tape, std::size_t k) {
  ErrorMatrix Q = tape.Q(k);
  for (const Block& block : tape.layout().blocks()) {
    if (IsNavigation(block.key.kind)) continue;
    Q.middleRows(block.offset, block.dim).setZero();
    Q.middleCols(block.offset, block.dim).setZero();
  }
  return Q;
}

/// cov(w | all) = Q - Q Lambda Q of each interval, so that I - Q^-1 cov has the
/// trace of Lambda Q.
double KnownImuNoise(const LinearTape& tape) {
  double sum = 0.0;
  ForEachLambda(tape, [&](std::size_t k, const ErrorMatrix& Lambda) {
    if (k > 0) sum += Lambda.cwiseProduct(IntervalNoise(tape, k)).sum();
  });
  return sum;
}

Eigen::VectorXd Whitened(const TapeMeasurement& z) {
  return Eigen::LLT<Eigen::MatrixXd>(z.S).matrixL().solve(z.innovation);
}

}  // namespace

Prior PriorOfComparison(const Dataset& dataset, const Problem& problem,
                        const State& x) {
  constexpr double kAnyPosition = 100.0;
  constexpr double kAnyVelocity = 100.0;
  const InitialState& given = dataset.initial;
  Prior prior = problem.prior;
  const auto widen = [&](BlockKind kind, const Eigen::Vector3d& sigma) {
    WidenBlock(problem.layout, kind, sigma, &prior.P);
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
  for (const Block& block : problem.layout.blocks()) {
    if (block.key.kind != BlockKind::kTimeOffset) continue;
    prior.x.parameters(block.parameter_offset) =
        x.parameters(block.parameter_offset);
  }
  return prior;
}

double LogClockPrior(const Dataset& dataset, const ErrorLayout& layout,
                     const State& x) {
  double log = 0.0;
  for (const Block& block : layout.blocks()) {
    if (block.key.kind != BlockKind::kTimeOffset) continue;
    const AidingStream& stream =
        dataset.streams[static_cast<std::size_t>(block.key.sensor)];
    if (stream.clock_unknown || !stream.sensor.time_offset_sigma) continue;
    const double off =
        (x.parameters(block.parameter_offset) - stream.sensor.time_offset) /
        *stream.sensor.time_offset_sigma;
    log -= 0.5 * off * off;
  }
  return log;
}

MarginalLikelihood MarginalLikelihoodOf(Problem problem,
                                        const std::vector<State>& nominal,
                                        const GateDecisions& used,
                                        LikelihoodParts parts) {
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i] == 0) problem.decisions[i] = 0;
  }
  const Timeline& timeline = problem.timeline;
  const LinearTape tape = RunLinearizedFilter(nominal, &problem);
  MarginalLikelihood out;
  std::size_t i = 0;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    const bool with_matrices = parts == LikelihoodParts::kWithNoise;
    for (const TapeMeasurement& z :
         with_matrices ? tape.measurements(k) : tape.headers(k)) {
      const bool counts = used[i++] != 0 && !z.withheld;
      if (!counts) continue;
      const int rows = static_cast<int>(z.innovation.size());
      const auto sensor = static_cast<std::size_t>(z.sensor);
      const double nis =
          z.accepted
              ? z.nis
              : std::min(z.nis, GateLimit(timeline.sensors()[sensor], rows));
      out.log += z.log_likelihood + 0.5 * (z.nis - nis);
      out.squares += nis;
      out.rows += rows;
      if (!z.accepted || parts == LikelihoodParts::kAlone) continue;
      const Measurement& measurement =
          timeline.measurements(k)[static_cast<std::size_t>(z.index)];
      out.whitened[{measurement.sensor, measurement.t}] = Whitened(z);
    }
  }
  if (parts == LikelihoodParts::kWithNoise) out.imu_noise = KnownImuNoise(tape);
  return out;
}

}  // namespace hindsight
