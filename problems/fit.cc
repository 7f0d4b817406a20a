#include "problems/fit.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "base/chi_square.h"
#include "base/error.h"
#include "filters/constant_scores.h"
#include "filters/forward_filter.h"
#include "filters/mixture_innovations.h"
#include "filters/side_agreement.h"
#include "problems/explanations.h"
#include "problems/judged_innovations.h"
#include "problems/leave_one_out.h"
#include "problems/shown_noise.h"

namespace hindsight {
namespace {

/// Of what `all` can tell, with the limit that any of them reaches by chance.
std::vector<AgreementFigure> FiguresOf(const std::vector<SideAgreement>& all,
                                       const LinearTape& tape) {
  std::vector<AgreementFigure> figures;
  for (const SideAgreement& one : all) {
    const char* block = one.block == BlockKind::kPosition   ? "position"
                        : one.block == BlockKind::kVelocity ? "velocity"
                                                            : "attitude";
    const char* words =
        one.of == SideAgreement::Of::kForwardAndBackward
            ? "{} differs from what is measured before to what is after"
            : "{} of the filter differs from that of the smoother";
    figures.push_back(
        {.what = fmt::format(fmt::runtime(words), block),
         .t = tape.t(one.epoch),
         .distance = one.distance,
         .limit = std::sqrt(ChiSquareQuantile(
             1.0 - kFalseAlarms / static_cast<double>(all.size()), one.dof))});
  }
  return figures;
}

/// Widens a sigma of a right model in one recording of twenty: no grade hangs on
/// it, and one that is too small misleads more than one that is too large.
constexpr double kNeedlesslyWidened = 0.05;

std::vector<ConstantExcess> ConstantsOf(const LinearTape& tape) {
  const ErrorLayout& layout = tape.layout();
  std::vector<int> components;
  for (const Block& block : layout.blocks()) {
    if (!block.evolution.is_constant()) continue;
    for (int i = 0; i < block.dim; ++i) components.push_back(block.offset + i);
  }
  const std::vector<double> factors =
      ExcessOfConstants(tape, components, kNeedlesslyWidened);
  std::vector<ConstantExcess> constants;
  for (std::size_t i = 0; i < components.size(); ++i) {
    if (factors[i] > 1.0) {
      constants.push_back({layout.ComponentName(components[i]), factors[i]});
    }
  }
  return constants;
}

std::vector<int> SensorsOf(const std::vector<InnovationFigure>& figures) {
  std::set<int> sensors;
  for (const InnovationFigure& one : figures) sensors.insert(one.sensor);
  return {sensors.begin(), sensors.end()};
}

/// What does not fit most, over its limit; less than one if all fits.
double Misfit(const Fit& fit) {
  double worst = LargestExcess(fit.figures) / kDoubtfulError;
  for (const Explanation& one : fit.explanations) {
    if (one.effect >= kDoubtfulShift)
      worst = std::max(worst, one.z / one.limit);
  }
  return worst;
}

/// Of a tape about `states`, but for what contradicts.
Fit FitOf(const Dataset& dataset, const Relinearised& solution,
          const std::vector<State>& states, const LinearTape& tape,
          const Problem& problem, const EpochCallback& callback) {
  Fit fit;
  fit.innovations = InnovationsOf(tape, problem.timeline, dataset);
  fit.figures = TestInnovations(fit.innovations, kFalseAlarms);
  const ExplanationSearch search(problem, states, tape, kFalseAlarms, callback);
  fit.explanations = search.Tell(solution);
  fit.agreement =
      FiguresOf(AgreementOfSides(tape, search.state_scores()), tape);
  fit.constants = ConstantsOf(tape);
  fit.tested = true;
  return fit;
}

/// Without any sensor that states too much all fits as well: this blames none.
void AddByShownNoise(const Dataset& dataset, const Relinearised& solution,
                     Problem* problem, const EpochCallback& callback,
                     Fit* fit) {
  for (Explanation& one :
       ExplainByShownNoise(dataset, solution, fit->innovations, kFalseAlarms,
                           *problem, callback)) {
    fit->explanations.push_back(std::move(one));
  }
}

}  // namespace

Fit JudgeFit(const Dataset& dataset, const Relinearised& solution,
             const std::vector<State>& near, const LinearTape& tape,
             Problem* problem, const EpochCallback& callback) {
  constexpr double kNearLimit = 0.8;
  try {
    Fit fit = FitOf(dataset, solution, near, tape, *problem, callback);
    if (Misfit(fit) < kNearLimit) {
      AddByShownNoise(dataset, solution, problem, callback, &fit);
      return fit;
    }
  } catch (const EstimationError&) {
    // It may hold about the solution's own states.
  }
  return JudgeFit(dataset, solution, problem, callback);
}

Fit JudgeFit(const Dataset& dataset, const Relinearised& solution,
             Problem* problem, const EpochCallback& callback) {
  Fit fit;
  if (solution.states.empty()) return fit;
  try {
    const LinearTape tape =
        RunLinearizedFilter(solution.states, problem, callback);
    fit = FitOf(dataset, solution, solution.states, tape, *problem, callback);
    const double misfit = Misfit(fit);
    if (misfit >= 1.0) {
      fit.contradiction =
          LeaveOneOut(dataset, solution, tape, SensorsOf(fit.figures),
                      fit.explanations, problem, callback);
      fit.contradiction->misfit = misfit;
    }
    AddByShownNoise(dataset, solution, problem, callback, &fit);
  } catch (const EstimationError&) {
    // What a smoother could not hold is told by evidence of its own.
  }
  return fit;
}

Fit JudgeFit(const Dataset& dataset, const Timeline& timeline,
             const ImmTape& tape) {
  const Judgeable judgeable(timeline, dataset);
  Fit fit;
  for (const MixtureInnovation& one : MixtureInnovations(tape)) {
    const TapeMeasurement& z =
        tape.tapes.front().measurements(one.epoch)[one.measurement];
    if (!judgeable.Judges(z)) continue;
    fit.innovations.push_back(
        judgeable.Of(one.epoch, z, one.scores, one.scores));
  }
  fit.figures = TestInnovations(fit.innovations, kFalseAlarms);
  fit.tested = true;
  return fit;
}

}  // namespace hindsight
