#include "problems/batch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "filters/iterated_smoother.h"
#include "problems/ceres_windows.h"
#include "problems/chain_problem.h"
#include "problems/iteration_progress.h"

namespace hindsight {
namespace {

/// The last step with a robust loss.
constexpr double kFineStep = 1e-8;
/// A step of this size is the last one without a loss: the error that it leaves
/// goes with its square.
constexpr double kLastNewtonStep = 1e-5;

double LastStep(const ChainProblem& chain) {
  return chain.HasLoss() ? kFineStep : kLastNewtonStep;
}

/// Rounding of the cost, as a fraction.
constexpr double kCostRounding = 1e-9;

/// Iterations that FinishByNewton usually takes.
constexpr double kLastSteps = 2.0;

/// Solves with the losses as they are; the first time with losses that
/// redescend, first with all their scales so wide that no residual is beyond
/// them, then halved with two iterations each.
Sweep SolveGraduated(const BatchOptions& options, bool first,
                     IterationProgress* progress, ChainProblem* chain) {
  constexpr int kIterationsPerStage = 2;
  constexpr double kWidest = 1024.0;
  chain->KeepFactors();
  if (first) {
    double widening = std::min(chain->LargestRobustRatio(), kWidest);
    for (; widening > 1.0; widening *= 0.5) {
      chain->SetWidening(widening);
      const double stages = std::ceil(std::log2(widening)) - 1.0;
      SolveWindows(options, kIterationsPerStage,
                   kIterationsPerStage * stages + kUsualIterations + kLastSteps,
                   progress, chain);
    }
    chain->SetWidening(1.0);
  }
  return SolveWindows(options, options.max_iterations, kLastSteps, progress,
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

/// Full Gauss-Newton steps of the whole chain for as long as each is less than half of
/// one of the two before, or with losses, to which the start is known to be near, lowers
/// the cost, as the steps of expectation-maximisation do. Where one does neither, as they
/// may swing about the solution, half steps follow. A step that moves what is weakly
/// determined may be larger than the one before it, which took off what is not.
/// Their cost may rise on the way: where a heading is uncertain the states lie along
/// an arc, and the way that only descends follows it in steps of metres. True, and
/// Ceres can be left out, if that ends within a rough step at a cost below the
/// start's: `next` is the step from there. Else the values are those of the start
/// again. Where steps with losses become no smaller, but are such as would be the last
/// without, rounding is what is left: how far the steps that finish it move it, in sigmas,
/// tells whether that is converged.
bool SettlesByNewton(const BatchOptions& options,
                     const std::vector<State>& start,
                     IterationProgress* progress, ChainProblem* chain,
                     Sweep* sweep, std::optional<ArrowLeastSquares>* next) {
  constexpr int kMaxSteps = 20;
  constexpr double kContraction = 0.5;
  constexpr double kPart = 0.5;
  const bool has_loss = chain->HasLoss();
  if (!options.newton_first || (has_loss && options.graduated)) return false;
  const int most = has_loss ? options.max_iterations : kMaxSteps;
  progress->Begin(most, kLastSteps);
  std::optional<ArrowLeastSquares>& step = *next;
  step.emplace(chain->GaussNewtonStep());
  // Where it begins at the solution, that step is the last one.
  if (chain->StepSize(*step) < LastStep(*chain)) return true;
  const double first_cost = chain->linearized_cost();
  double cost = first_cost;
  bool descends = has_loss;
  double part = 1.0;
  double before = std::numeric_limits<double>::infinity();
  double earlier = 0.0;
  for (int i = 1; i <= most; ++i) {
    const double size = chain->StepSize(*step);
    const bool contracts = size < kContraction * std::max(before, earlier);
    if (!contracts && !descends) {
      if (has_loss && part < 1.0 && size < kLastNewtonStep &&
          cost <= first_cost * (1.0 + kCostRounding)) {
        sweep->converged = false;
        sweep->iterations += i - 1;
        return true;
      }
      if (!has_loss || part < 1.0) break;
      part = kPart;
    }
    chain->Apply(*step, part);
    const double ratio = size / RoughStep(*chain);
    progress->After(i, ratio);
    earlier = i > 1 ? before : 0.0;
    before = size;
    step.reset();
    step.emplace(chain->GaussNewtonStep());
    const double limit = cost * (1.0 + kCostRounding);
    cost = chain->linearized_cost();
    descends = has_loss && cost <= limit;
    if (ratio > 1.0) continue;
    if (!(cost <= first_cost * (1.0 + kCostRounding))) break;
    sweep->iterations += i;
    return true;
  }
  step.reset();
  chain->Set(start);
  return false;
}

/// Full Gauss-Newton steps by the chain's own solver, which are taken without
/// asking the cost. In a long chain they are also what moves the constants and
/// what couples the windows: after a large step the windows are solved anew.
/// `first`, if there is one, is the first step. Returns the covariances from the last.
CovarianceSeries FinishByNewton(const BatchOptions& options,
                                std::optional<ArrowLeastSquares> first,
                                IterationProgress* progress,
                                ChainProblem* chain, Sweep* sweep) {
  constexpr int kMaxSteps = 4;
  constexpr int kMaxSweeps = 10;
  const bool windowed = IsWindowed(options, *chain);
  const double last = LastStep(*chain);
  progress->Begin(kMaxSteps, 0.0);
  for (int i = 1;; ++i) {
    const ArrowLeastSquares step =
        first ? *std::exchange(first, std::nullopt) : chain->GaussNewtonStep();
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
    *sweep = SolveWindows(options, options.max_iterations, kLastSteps, progress,
                          chain);
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
  IterationProgress progress(options.callback);
  constexpr int kMaxReintegrations = 5;
  for (int outer = 0; outer < kMaxReintegrations; ++outer) {
    const std::vector<State>& start = outer == 0 ? initial : result.states;
    ChainProblem chain(start, problem);
    Sweep sweep;
    std::optional<ArrowLeastSquares> next;
    if (!SettlesByNewton(options, start, &progress, &chain, &sweep, &next)) {
      sweep = SolveGraduated(options, options.graduated && outer == 0,
                             &progress, &chain);
    }
    result.states = chain.States();
    if (!AnySummaryIsStale(*problem, result.states)) {
      result.P =
          FinishByNewton(options, std::move(next), &progress, &chain, &sweep);
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
