#include "problems/ceres_windows.h"

#include <ceres/iteration_callback.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <cmath>
#include <exception>

#include "base/error.h"

namespace hindsight {
namespace {

/// Root mean square of a step, a node [m, m/s, rad...], below which the cost
/// can no longer tell a better state from a worse one: with ECEF positions of
/// 6.4e6 m every residual carries 1e-9 m of rounding. The chain's own
/// steps go on from there.
constexpr double kRoughStep = 1e-3;
/// The same with a robust loss: the last steps then shrink by a constant factor
/// only, and Ceres must come nearer.
constexpr double kRoughRobustStep = 1e-6;

/// Ends Ceres's iteration at rough steps. Hands the iterations to the caller
/// and keeps what the caller throws, as an exception must not cross Ceres.
class Callback : public ceres::IterationCallback {
 public:
  Callback(double step_limit, IterationProgress* progress)
      : step_limit_(step_limit), progress_(*progress) {}

  ceres::CallbackReturnType operator()(
      const ceres::IterationSummary& summary) override {
    try {
      progress_.After(summary.iteration, summary.step_norm / step_limit_);
    } catch (...) {
      thrown_ = std::current_exception();
      return ceres::SOLVER_ABORT;
    }
    const bool settled =
        summary.iteration > 0 && summary.step_norm < step_limit_;
    return settled ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
                   : ceres::SOLVER_CONTINUE;
  }

  void Rethrow() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  double step_limit_;
  IterationProgress& progress_;
  std::exception_ptr thrown_;
};

ceres::Solver::Options SolverOptions(const BatchOptions& options) {
  ceres::Solver::Options ceres_options;
  ceres_options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  ceres_options.sparse_linear_algebra_library_type = ceres::SUITE_SPARSE;
  ceres_options.max_num_iterations = options.max_iterations;
  // The problem is nearly linear from a smoother's start: a small first trust
  // region would only shorten good steps.
  ceres_options.initial_trust_region_radius = 1e16;
  ceres_options.max_trust_region_radius = 1e32;
  ceres_options.function_tolerance = 1e-12;
  ceres_options.gradient_tolerance = 1e-14;
  // Relative to |x|, of which ECEF positions are 6.4e6 m a node: only a step of
  // rounding size may end the iteration.
  ceres_options.parameter_tolerance = 1e-16;
  // Whitened information needs no scaling before its Cholesky decomposition.
  ceres_options.jacobi_scaling = false;
  ceres_options.logging_type = ceres::SILENT;
  ceres_options.num_threads = 1;
  return ceres_options;
}

/// The nodes [begin, end) that one Ceres problem moves.
struct Window {
  std::size_t begin = 0;
  std::size_t end = 0;
};

std::vector<Window> Windows(const BatchOptions& options, std::size_t nodes) {
  const std::size_t count =
      nodes <= options.whole_nodes
          ? 1
          : (nodes + options.window_nodes - 1) / options.window_nodes;
  std::vector<Window> windows;
  for (std::size_t i = 0; i < count; ++i) {
    windows.push_back({nodes * i / count, nodes * (i + 1) / count});
  }
  return windows;
}

/// The factors that see the window, and what else they see held fixed.
void AddBlocks(const Window& window, ChainProblem* chain,
               ceres::Manifold* manifold, ceres::Problem* problem) {
  const int size = chain->blocks().node_ambient_dim();
  const bool whole = window.begin == 0 && window.end == chain->node_count();
  const auto inside = [&](int k) {
    const auto node = static_cast<std::size_t>(k);
    return node >= window.begin && node < window.end;
  };
  for (std::size_t k = window.begin; k < window.end; ++k) {
    problem->AddParameterBlock(chain->node_values(k), size, manifold);
  }
  for (std::size_t i = 0; i < chain->factors().size(); ++i) {
    TangentFactor* factor = chain->factors()[i].get();
    const std::vector<int>& nodes = factor->nodes();
    if (std::none_of(nodes.begin(), nodes.end(), inside)) continue;
    const std::vector<double*> parameters = chain->ParametersOf(*factor);
    problem->AddResidualBlock(factor, chain->loss(i), parameters);
    for (std::size_t j = 0; !whole && j < parameters.size(); ++j) {
      if (j >= nodes.size() || !inside(nodes[j])) {
        problem->SetParameterBlockConstant(parameters[j]);
      }
    }
  }
}

ceres::Problem::Options ProblemOptions() {
  ceres::Problem::Options options;
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.disable_all_safety_checks = true;
  return options;
}

}  // namespace

double RoughStep(const ChainProblem& chain) {
  return chain.HasLoss() ? kRoughRobustStep : kRoughStep;
}

bool IsWindowed(const BatchOptions& options, const ChainProblem& chain) {
  return chain.node_count() > options.whole_nodes;
}

Sweep SolveWindows(const BatchOptions& options, int max_iterations,
                   double later, IterationProgress* progress,
                   ChainProblem* chain) {
  NodeManifold manifold(&chain->blocks());
  Sweep sweep;
  const std::vector<Window> windows = Windows(options, chain->node_count());
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const Window& window = windows[i];
    const int usual = i == 0 ? kUsualIterations : sweep.iterations;
    progress->Begin(
        max_iterations,
        later + usual * static_cast<double>(windows.size() - 1 - i));
    ceres::Problem problem(ProblemOptions());
    AddBlocks(window, chain, &manifold, &problem);
    const auto nodes = static_cast<double>(window.end - window.begin);
    Callback callback(RoughStep(*chain) * std::sqrt(nodes), progress);
    ceres::Solver::Options solver_options = SolverOptions(options);
    solver_options.max_num_iterations = max_iterations;
    solver_options.callbacks.push_back(&callback);
    ceres::Solver::Summary summary;
    ceres::Solve(solver_options, &problem, &summary);
    callback.Rethrow();
    if (!summary.IsSolutionUsable()) {
      throw EstimationError("batch solver failed: " + summary.message);
    }
    sweep.iterations = std::max(
        sweep.iterations, static_cast<int>(summary.iterations.size()) - 1);
    sweep.ceres_iterations = sweep.iterations;
    sweep.converged =
        sweep.converged && (summary.termination_type == ceres::CONVERGENCE ||
                            summary.termination_type == ceres::USER_SUCCESS);
  }
  return sweep;
}

}  // namespace hindsight
