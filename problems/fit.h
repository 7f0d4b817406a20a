#ifndef HINDSIGHT_PROBLEMS_FIT_H_
#define HINDSIGHT_PROBLEMS_FIT_H_

#include <optional>
#include <vector>

#include "dataset/dataset.h"
#include "evaluation/agreement.h"
#include "evaluation/contradicted_sensor.h"
#include "evaluation/explanation.h"
#include "evaluation/innovation_test.h"
#include "filters/imm.h"
#include "problems/linearisation.h"
#include "timeline/problem.h"

namespace hindsight {

/// What the measurements say of the model that a solution is of.
struct Fit {
  /// Of the accepted ones, but of sensors with a robust loss: whose errors are
  /// not said to be normal.
  std::vector<NormalisedInnovation> innovations;
  std::vector<InnovationFigure> figures;
  std::vector<Explanation> explanations;
  std::vector<AgreementFigure> agreement;
  std::optional<LeftOutSensor> contradiction;  ///< sought where it does not fit
  std::vector<ConstantExcess> constants;
  /// False where no filter holds about the states, or none of it is invertible:
  /// then nothing speaks against the model, nor for it.
  bool tested = false;
};

/// Linearises `problem` about the states of a solution and holds its innovations
/// against it, each test with kFalseAlarms. `dataset` is what the timeline is
/// built from; `callback` hears of each epoch of each pass.
Fit JudgeFit(const Dataset& dataset, const Relinearised& solution,
             Problem* problem, const EpochCallback& callback = nullptr);

/// The same of a solution within a tenth of a sigma of the states `near`, which
/// `tape` is linearised about: that spares a pass of the filter. What comes near a
/// limit is judged about the solution's own states nevertheless.
Fit JudgeFit(const Dataset& dataset, const Relinearised& solution,
             const std::vector<State>& near, const LinearTape& tape,
             Problem* problem, const EpochCallback& callback);

/// The innovations of an IMM against the mixture that predicted them, with
/// kFalseAlarms. They are of the filter, about its own estimates: what would
/// explain them, and what both sides say, is not sought here.
Fit JudgeFit(const Dataset& dataset, const Timeline& timeline,
             const ImmTape& tape);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_FIT_H_
