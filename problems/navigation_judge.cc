#include "problems/navigation_judge.h"

#include <cmath>
#include <set>
#include <string>

#include "evaluation/series_fold.h"
#include "evaluation/statistics.h"

namespace hindsight {
namespace {

constexpr double kWide = 5.0;

/// The nodes of a solution at those of `times` that it has, or all of them.
std::vector<std::size_t> JudgedNodes(std::vector<double> times,
                                     const Solution& solution) {
  std::vector<double> own;
  for (const State& x : solution.states) own.push_back(x.t);
  if (times.empty()) times = own;
  return MatchTimes(own, &times);
}

void AddErrors(const StateErrors& errors, RunRecord* record) {
  record->t = errors.t;
  record->series["yaw"] = errors.yaw;
  record->series["nees"] = errors.nees;
  record->values.insert(record->values.end(),
                        {{"heading_rms", Rms(errors.yaw)},
                         {"attitude_rms", Rms(errors.attitude.Norms())},
                         {"attitude_nees", Mean(errors.attitude.nees)},
                         {"outside_5_sigma", errors.ShareBeyond(kWide)}});
  const PartErrors& position = errors.position;
  if (position.e.empty()) return;
  for (int axis = 0; axis < 3; ++axis) {
    record->series[std::string("position_") + "ned"[axis]] =
        position.Component(axis);
  }
  record->values.insert(
      record->values.end(),
      {{"position_rms", Rms(position.Norms())},
       {"position_max", Largest(position.Norms())},
       {"position_nees", Mean(position.nees)},
       {"end_horizontal", position.e.back().head<2>().norm()}});
}

/// The rules that lower the grade, and the constants that are wrong.
void AddEvidence(const Dataset& dataset, const Solution& solution,
                 RunRecord* record) {
  std::set<std::string> rules;
  for (const Evidence& evidence : solution.evidence) {
    if (evidence.grade != Grade::kUsable) rules.insert(evidence.rule);
  }
  for (const std::string& rule : rules) {
    record->values.emplace_back("rule:" + rule, 1.0);
  }
  double beyond = 0.0;
  for (const ConstantEstimate& c : solution.constants) {
    const auto truth = dataset.true_constants.find(c.name);
    if (truth == dataset.true_constants.end()) continue;
    if (std::abs(c.value - truth->second) > kWide * c.sigma) beyond += 1.0;
  }
  record->values.emplace_back("constants_beyond_5_sigma", beyond);
}

}  // namespace

StateErrors JudgeSolution(const Dataset& dataset,
                          const std::vector<double>& times,
                          const Solution& solution, RunRecord* record) {
  StateErrors errors =
      ErrorsOf(dataset, solution.layout, solution.states, solution.covariances,
               JudgedNodes(times, solution));
  double nis = 0.0, rows = 0.0;
  for (const ResidualRecord& residual : solution.residuals) {
    if (!residual.accepted || residual.withheld) continue;
    nis += residual.nis;
    rows += static_cast<double>(residual.residual.size());
  }
  record->values = {{kSeconds, solution.seconds},
                    {"nis_sum", nis},
                    {"nis_rows", rows},
                    {"states", static_cast<double>(errors.states)}};
  record->grade = solution.grade;
  record->failed = !solution.converged;
  record->answered = solution.converged;
  AddEvidence(dataset, solution, record);
  AddErrors(errors, record);
  return errors;
}

}  // namespace hindsight
