#ifndef HINDSIGHT_PROBLEMS_FIT_H_
#define HINDSIGHT_PROBLEMS_FIT_H_

#include <optional>
#include <vector>

#include "dataset/dataset.h"
#include "evaluation/agreement.h"
#include "evaluation/contradicted_sensor.h"
#include "evaluation/explanation.h"
#include "evaluation/innovation_test.h"
#include "problems/linearisation.h"
#include "timeline/problem.h"

namespace hindsight {

/// What the measurements say of the model that a solution is of.
struct Fit {
  std::vector<NormalisedInnovation> innovations;  ///< of the accepted ones
  std::vector<InnovationFigure> figures;
  std::vector<Explanation> explanations;
  std::vector<AgreementFigure> agreement;
  std::optional<LeftOutSensor> contradiction;  ///< sought where it does not fit
  std::vector<ConstantExcess> constants;
};

/// Linearises `problem` about the states of a solution and holds its innovations
/// against it, each test with kFalseAlarms. Empty where there are no states or
/// a covariance is not positive definite. `dataset` is what the timeline is
/// built from.
Fit JudgeFit(const Dataset& dataset, const Relinearised& solution,
             Problem* problem);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_FIT_H_
