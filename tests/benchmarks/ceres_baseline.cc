#include <ceres/covariance.h>
#include <ceres/iteration_callback.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <cmath>
#include <stdexcept>

#include "benchmarks/baselines.h"
#include "benchmarks/last_step.h"
#include "problems/chain_problem.h"

namespace hindsight {
namespace {

/// Ceres's own tolerances are relative to positions of 6.4e6 m.
class StopAtLastStep : public ceres::IterationCallback {
 public:
  explicit StopAtLastStep(std::size_t nodes) : root_(std::sqrt(nodes)) {}

  ceres::CallbackReturnType operator()(
      const ceres::IterationSummary& summary) override {
    const bool last =
        summary.iteration > 0 && summary.step_norm < kLastStep * root_;
    return last ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  double root_;
};

CovarianceSeries Marginals(ChainProblem* chain, ceres::Problem* problem) {
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::SPARSE_QR;
  options.sparse_linear_algebra_library_type = ceres::SUITE_SPARSE;
  ceres::Covariance covariance(options);
  std::vector<std::pair<const double*, const double*>> diagonal;
  for (std::size_t k = 0; k < chain->node_count(); ++k) {
    diagonal.emplace_back(chain->node_values(k), chain->node_values(k));
  }
  if (!covariance.Compute(diagonal, problem)) {
    throw std::runtime_error("ceres::Covariance failed");
  }
  const int n = chain->blocks().node_dim();
  CovarianceSeries series(n, chain->node_count());
  ErrorMatrix P(n, n);
  for (std::size_t k = 0; k < chain->node_count(); ++k) {
    covariance.GetCovarianceBlockInTangentSpace(
        chain->node_values(k), chain->node_values(k), P.data());
    series.Set(k, P);
  }
  return series;
}

}  // namespace

BaselineResult SolveByCeres(const std::vector<State>& initial,
                            bool with_covariances, Problem* problem) {
  ChainProblem chain(initial, problem);
  chain.KeepFactors();
  NodeManifold manifold(&chain.blocks());
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem ceres_problem(ownership);
  for (std::size_t k = 0; k < chain.node_count(); ++k) {
    ceres_problem.AddParameterBlock(
        chain.node_values(k), chain.blocks().node_ambient_dim(), &manifold);
  }
  for (const auto& factor : chain.factors()) {
    ceres_problem.AddResidualBlock(factor.get(), nullptr,
                                   chain.ParametersOf(*factor));
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.initial_trust_region_radius = 1e16;
  options.max_trust_region_radius = 1e32;
  options.function_tolerance = 0.0;
  options.gradient_tolerance = 0.0;
  options.parameter_tolerance = 0.0;
  options.jacobi_scaling = false;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  StopAtLastStep callback(chain.node_count());
  options.callbacks.push_back(&callback);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &ceres_problem, &summary);
  if (!summary.IsSolutionUsable()) throw std::runtime_error(summary.message);
  return {.states = chain.States(),
          .P = with_covariances ? Marginals(&chain, &ceres_problem)
                                : CovarianceSeries(),
          .iterations = static_cast<int>(summary.iterations.size()) - 1};
}

}  // namespace hindsight
