#include "problems/batch.h"

#include <ceres/iteration_callback.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>

#include "base/error.h"
#include "filters/iterated_smoother.h"
#include "problems/chain_problem.h"
#include "problems/iteration_progress.h"

namespace hindsight {
namespace {

/// Root mean square of a step, a node [m, m/s, rad...], below which the cost
/// can no longer tell a better state from a worse one: with ECEF positions of
/// 6.4e6 m every residual carries 1e-9 m of rounding. FinishByNewton goes on
/// from there.
constexpr double kRoughStep = 1e-3;
/// The same with a robust loss: the last steps then shrink by a constant factor
/// only, and Ceres must come nearer.
constexpr double kRoughRobustStep = 1e-6;
constexpr double kFineStep = 1e-8;
/// A step of this size is the last one without a loss: the error that it leaves
/// goes with its square.
constexpr double kLastNewtonStep = 1e-5;

/// Rounding of the cost, as a fraction.
constexpr double kCostRounding = 1e-9;

/// Iterations that a solve usually takes in Ceres, and in FinishByNewton after
/// it, by which the remaining time is told.
constexpr int kUsualIterations = 3;
constexpr double kLastSteps = 2.0;

double RoughStep(const ChainProblem& chain) {
  return chain.HasLoss() ? kRoughRobustStep : kRoughStep;
}

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

struct Sweep {
  int iterations = 0;        ///< the most of any window
  int ceres_iterations = 0;  ///< those among them that were Ceres's
  bool converged = true;
};

/// Every window once, from the first to the last; `later` iterations are
/// expected after them.
Sweep SolveOnce(const BatchOptions& options, int max_iterations, double later,
                IterationProgress* progress, ChainProblem* chain) {
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

/// Solves with the losses as they are; the first time with losses that
/// redescend, first with all their scales so wide that no residual is beyond
/// them, then halved with two iterations each.
Sweep SolveGraduated(const BatchOptions& options, bool first,
                     IterationProgress* progress, ChainProblem* chain) {
  constexpr int kIterationsPerStage = 2;
  constexpr double kWidest = 1024.0;
  if (first) {
    double widening = std::min(chain->LargestRobustRatio(), kWidest);
    for (; widening > 1.0; widening *= 0.5) {
      chain->SetWidening(widening);
      const double stages = std::ceil(std::log2(widening)) - 1.0;
      SolveOnce(options, kIterationsPerStage,
                kIterationsPerStage * stages + kUsualIterations + kLastSteps,
                progress, chain);
    }
    chain->SetWidening(1.0);
  }
  return SolveOnce(options, options.max_iterations, kLastSteps, progress,
                   chain);
}

bool AnySummaryIsStale(const Problem& problem,
                       const std::vector<State>& states) {
  for (std::size_t k = 0; k + 1 < states.size(); ++k) {
    if (NeedsReintegration(problem.timeline.Summary(k),
                           CalibrationOf(problem.layout, states[k]))) {
      return true;
    }
  }
  return false;
}

bool IsWindowed(const BatchOptions& options, const ChainProblem& chain) {
  return chain.node_count() > options.whole_nodes;
}

/// Without losses: full Gauss-Newton steps of the whole chain for as long as each
/// is less than half of the one before. Their cost may rise on the way: where a
/// heading is uncertain the states lie along an arc, and the way that only
/// descends follows it in steps of metres. True, and Ceres can be left out, if
/// that ends within a rough step at a cost below the start's; else the values are
/// those of the start again.
bool ContractsByNewton(const BatchOptions& options,
                       const std::vector<State>& start,
                       IterationProgress* progress, ChainProblem* chain,
                       Sweep* sweep) {
  constexpr int kMaxSteps = 20;
  constexpr double kContraction = 0.5;
  if (chain->HasLoss() || !options.newton_first) return false;
  const double cost = chain->Cost();
  progress->Begin(kMaxSteps, kLastSteps);
  double before = std::numeric_limits<double>::infinity();
  for (int i = 1; i <= kMaxSteps; ++i) {
    const ArrowLeastSquares step = chain->GaussNewtonStep();
    const double size = chain->StepSize(step);
    if (!(size < kContraction * before)) break;
    chain->Apply(step);
    const double ratio = size / RoughStep(*chain);
    progress->After(i, ratio);
    before = size;
    if (ratio > 1.0) continue;
    if (chain->Cost() > cost * (1.0 + kCostRounding)) break;
    sweep->iterations += i;
    return true;
  }
  chain->Set(start);
  return false;
}

/// Full Gauss-Newton steps by the chain's own solver, which are taken without
/// asking the cost. In a long chain they are also what moves the constants and
/// what couples the windows: after a large step the windows are solved anew.
/// Returns the covariances from the last step.
CovarianceSeries FinishByNewton(const BatchOptions& options,
                                IterationProgress* progress,
                                ChainProblem* chain, Sweep* sweep) {
  constexpr int kMaxSteps = 4;
  constexpr int kMaxSweeps = 10;
  const bool windowed = IsWindowed(options, *chain);
  const double last = chain->HasLoss() ? kFineStep : kLastNewtonStep;
  progress->Begin(kMaxSteps, 0.0);
  for (int i = 1;; ++i) {
    const ArrowLeastSquares step = chain->GaussNewtonStep();
    ++sweep->iterations;
    const double size = chain->StepSize(step);
    chain->Apply(step);
    progress->After(i, size / last);
    const bool rough = windowed && size > RoughStep(*chain);
    if (size < last || i == (rough ? kMaxSweeps : kMaxSteps)) {
      sweep->converged = sweep->converged && !rough;
      return chain->Marginals(step);
    }
    if (!rough) continue;
    const Sweep before = *sweep;
    *sweep =
        SolveOnce(options, options.max_iterations, kLastSteps, progress, chain);
    sweep->iterations += before.iterations;
    sweep->ceres_iterations += before.ceres_iterations;
    progress->Begin(kMaxSteps, 0.0);
  }
}

bool AllFinite(const std::vector<State>& states) {
  return std::all_of(states.begin(), states.end(), [](const State& x) {
    return x.p_e.allFinite() && x.v_e.allFinite() &&
           x.q_eb.coeffs().allFinite() && x.b_g.allFinite() &&
           x.b_a.allFinite() && x.parameters.allFinite();
  });
}

}  // namespace

BatchResult SolveBatch(const std::vector<State>& initial,
                       const BatchOptions& options, Problem* problem) {
  BatchResult result;
  result.states = initial;
  IterationProgress progress(options.callback);
  constexpr int kMaxReintegrations = 5;
  for (int outer = 0; outer < kMaxReintegrations; ++outer) {
    ChainProblem chain(result.states, problem);
    Sweep sweep;
    if (!ContractsByNewton(options, result.states, &progress, &chain, &sweep)) {
      sweep = SolveGraduated(options, options.graduated && outer == 0,
                             &progress, &chain);
    }
    result.states = chain.States();
    if (!AnySummaryIsStale(*problem, result.states)) {
      result.P = FinishByNewton(options, &progress, &chain, &sweep);
    }
    result.iterations += sweep.iterations;
    result.ceres_iterations += sweep.ceres_iterations;
    const std::vector<State> before = std::move(result.states);
    result.states = chain.States();
    if (AnySummaryIsStale(*problem, result.states)) continue;
    // Ceres may run out of iterations when micrometres are left, which the
    // Newton steps take.
    result.converged =
        AllFinite(result.states) &&
        (sweep.converged ||
         LargestMoveInSigmas(problem->layout, before, result.states, result.P) <
             kSettledStep);
    return result;
  }
  result.converged = false;
  result.P = BatchMarginals(result.states, problem);
  return result;
}

CovarianceSeries BatchMarginals(const std::vector<State>& states,
                                Problem* problem) {
  ChainProblem chain(states, problem);
  return chain.Marginals(chain.GaussNewtonStep());
}

}  // namespace hindsight
