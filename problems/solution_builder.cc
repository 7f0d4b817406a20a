#include "problems/solution_builder.h"

#include <Eigen/Cholesky>
#include <utility>

#include "base/parallel.h"

namespace hindsight {
namespace {

ResidualRecord MakeRecord(const Measurement& z, double t, bool accepted) {
  ResidualRecord record;
  record.t = t;
  record.sensor = z.sensor;
  record.accepted = accepted || z.withheld;
  record.withheld = z.withheld;
  if (!record.accepted) record.weight = 0.0;
  return record;
}

}  // namespace

Solution FilterSolution(const LinearTape& tape) {
  Solution solution;
  solution.layout = tape.layout();
  auto covariances = InBackground([&tape] {
    CovarianceSeries P(tape.dim(), tape.size());
    for (std::size_t k = 0; k < tape.size(); ++k) P.Set(k, tape.P_plus(k));
    return P;
  });
  solution.states.reserve(tape.size());
  std::size_t measurements = 0;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    measurements += tape.headers(k).size();
  }
  solution.residuals.reserve(measurements);
  for (std::size_t k = 0; k < tape.size(); ++k) {
    const TapeEpoch& epoch = tape.epoch(k);
    solution.states.push_back(epoch.x_plus);
    for (const TapeMeasurement& z : tape.measurements(k)) {
      ResidualRecord record;
      record.t = epoch.t;
      record.sensor = z.sensor;
      record.accepted = z.accepted || z.withheld;
      record.withheld = z.withheld;
      record.residual = z.innovation;
      if (z.weight < 1.0) {
        // As for smoothers, S has the stated R, not the one that the loss has
        // divided by the weight.
        const RowMatrix S = z.S - (1.0 - z.weight) * z.R;
        record.sigma = S.diagonal().cwiseSqrt();
        record.nis = Eigen::LLT<RowMatrix>(S)
                         .matrixL()
                         .solve(record.residual)
                         .squaredNorm();
      } else {
        record.sigma = z.S.diagonal().cwiseSqrt();
        record.nis = z.nis;
      }
      record.weight = record.accepted ? z.weight : 0.0;
      solution.residuals.push_back(std::move(record));
    }
  }
  solution.covariances = covariances.get();
  return solution;
}

namespace {

/// The residual of a measurement of node k at x, and what it is judged by, where P is
/// the covariance of x.
ResidualRecord SmoothedRecord(const Problem& problem, std::size_t k,
                              const Measurement& measurement, bool used,
                              const State& x, const ErrorMatrix& P) {
  const Timeline& timeline = problem.timeline;
  LinearizedMeasurement z;
  Evaluate(measurement, timeline.Context(k, measurement, problem.layout, x),
           &z);
  ResidualRecord record = MakeRecord(measurement, timeline.node(k).t, used);
  const RobustLoss& loss =
      timeline.sensors()[static_cast<std::size_t>(measurement.sensor)].loss;
  if (used && loss.kind != RobustLoss::Kind::kNone) {
    record.weight = loss.OfRows(static_cast<int>(z.residual.size()))
                        .Weight(Eigen::LLT<RowMatrix>(z.R)
                                    .matrixL()
                                    .solve(z.residual)
                                    .squaredNorm());
  }
  // A measurement to which the loss leaves next to no weight has no part in
  // the state: the errors of both add up in its residual.
  const bool takes_part = used && record.weight > 0.1;
  const RowMatrix HPH = z.H * P * z.H.transpose();
  RowMatrix S = takes_part ? RowMatrix(z.R - HPH) : RowMatrix(z.R + HPH);
  Eigen::LLT<RowMatrix> llt(S);
  if (llt.info() != Eigen::Success) {
    // The measurement alone decides its state: its residual is zero by
    // construction and its covariance lost to rounding.
    S = z.R;
    llt.compute(S);
  }
  record.residual = z.residual;
  record.sigma = S.diagonal().cwiseSqrt();
  record.nis = llt.matrixL().solve(z.residual).squaredNorm();
  return record;
}

}  // namespace

Solution SmoothedSolution(const Problem& problem, std::vector<State> states,
                          CovarianceSeries P) {
  constexpr std::size_t kNodesOfThread = 512;
  const Timeline& timeline = problem.timeline;
  Solution solution;
  solution.layout = problem.layout;
  std::vector<std::size_t> first = {0};  // of each node, in all measurements
  first.reserve(timeline.size() + 1);
  for (std::size_t k = 0; k < timeline.size(); ++k) {
    first.push_back(first.back() + timeline.measurements(k).size());
  }
  solution.residuals.resize(first.back());
  ForRanges(
      timeline.size(), kNodesOfThread, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
          const auto measurements = timeline.measurements(k);
          if (measurements.empty()) continue;
          const ErrorMatrix P_k = P.Get(k);
          for (std::size_t i = 0; i < measurements.size(); ++i) {
            const std::size_t index = first[k] + i;
            solution.residuals[index] =
                SmoothedRecord(problem, k, measurements[i],
                               problem.decisions[index] != 0, states[k], P_k);
          }
        }
      });
  solution.states = std::move(states);
  solution.covariances = std::move(P);
  return solution;
}

}  // namespace hindsight
