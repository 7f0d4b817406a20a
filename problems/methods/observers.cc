#include <string>
#include <utility>

#include "base/processor_time.h"
#include "filters/forward_filter.h"
#include "problems/method.h"
#include "problems/method_stage.h"
#include "problems/solution_builder.h"

namespace hindsight {
namespace {

Solution Observe(const char* name, const CovarianceOptions& covariance,
                 MethodStage* stage) {
  ForwardStage& forward = stage->forward();
  const double t0 = ProcessorSeconds();
  Problem problem = forward.CausalProblem();
  const LinearTape tape = RunForwardFilter(
      {forward.options().error, covariance}, &problem, forward.Progress(name));
  Solution solution = FilterSolution(tape);
  const bool has_gamma = covariance.rule == RiccatiRule::kHInfinity;
  const ObserverFigures figures = {
      .gamma = has_gamma ? covariance.gamma : 0.0,
      .alpha = has_gamma ? 0.0 : covariance.alpha,
      .delta = has_gamma ? 0.0 : covariance.delta,
      .steps = static_cast<int>(tape.size()) - 1,
      .back_offs = tape.bound().back_offs,
      .least_information = tape.bound().least_information};
  if (figures.back_offs > 0) {
    solution.notes.push_back("no bounded gain at " +
                             std::to_string(figures.back_offs) + " of " +
                             std::to_string(figures.steps) +
                             " steps, which it took without the weight of L'L");
  }
  solution.observer = figures;
  solution.seconds = ProcessorSeconds() - t0;
  return solution;
}

Solution RunHInfinity(MethodStage* stage) {
  return Observe("hinf", stage->forward().options().h_infinity, stage);
}

Solution RunModifiedHInfinity(MethodStage* stage) {
  return Observe("modified_hinf",
                 stage->forward().options().modified_h_infinity, stage);
}

}  // namespace

extern const Method kHinfMethod;
const Method kHinfMethod = {
    .name = "hinf",
    .help =
        "forward observer with an H-infinity Riccati equation (--gamma);\n"
        "its P is no covariance: rts and two_filter smooth the ekf alone",
    .traits = TraitsOf({MethodTrait::kForward, MethodTrait::kDependsOnError,
                        MethodTrait::kHInfinity}),
    .run = RunHInfinity};

extern const Method kModifiedHinfMethod;
const Method kModifiedHinfMethod = {
    .name = "modified_hinf",
    .help =
        "hinf with a degree of stability (--alpha) and a free weight\n"
        "(--delta)",
    .traits = TraitsOf({MethodTrait::kForward, MethodTrait::kDependsOnError,
                        MethodTrait::kModifiedHInfinity}),
    .run = RunModifiedHInfinity};

}  // namespace hindsight
