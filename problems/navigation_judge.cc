#include "problems/navigation_judge.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <set>
#include <string>

#include "evaluation/series_fold.h"
#include "evaluation/statistics.h"
#include "evaluation/true_states.h"

namespace hindsight {
namespace {

/// The nodes of a solution at those of `times` that it has, or all of them.
std::vector<std::size_t> JudgedNodes(std::vector<double> times,
                                     const Solution& solution) {
  std::vector<double> own;
  for (const State& x : solution.states) own.push_back(x.t);
  if (times.empty()) times = own;
  return MatchTimes(own, &times);
}

/// Three components of an error against their covariance.
struct PartError {
  double length = 0.0;
  double nees = 0.0;
  bool beyond = false;  ///< 5 sigmas, in any component
};

PartError PartOf(const ErrorVector& e, const ErrorMatrix& P, int offset) {
  constexpr double kWide = 5.0;
  const Eigen::Vector3d part = e.segment<3>(offset);
  const Eigen::Matrix3d P_part = P.block<3, 3>(offset, offset);
  const Eigen::Vector3d sigma = P_part.diagonal().cwiseSqrt();
  return {part.norm(), part.dot(P_part.llt().solve(part)),
          (part.cwiseAbs() - kWide * sigma).maxCoeff() > 0.0};
}

/// Errors of the solution at those nodes into the record.
void JudgeNodes(const Solution& solution, const std::vector<std::size_t>& nodes,
                const std::vector<State>& truth,
                const std::vector<int>& components, RunRecord* record) {
  const Block* p = solution.layout.Find(BlockKind::kPosition);
  const int a = solution.layout.Find(BlockKind::kAttitude)->offset;
  std::vector<double> distance, angle, position_nees, attitude_nees, beyond;
  double end_horizontal = 0.0;
  auto& series = record->series;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const State& x = solution.states[nodes[i]];
    const ErrorVector e = Local(solution.layout, x, truth[i]);
    const ErrorMatrix P = solution.covariances.Get(nodes[i]);
    record->t.push_back(truth[i].t);
    series["yaw"].push_back(WrapAngle(truth[i].euler().z() - x.euler().z()));
    const Eigen::VectorXd known = e(components);
    const Eigen::MatrixXd P_known = P(components, components);
    series["nees"].push_back(known.dot(P_known.llt().solve(known)));
    const PartError attitude = PartOf(e, P, a);
    angle.push_back(attitude.length);
    attitude_nees.push_back(attitude.nees);
    beyond.push_back(attitude.beyond ? 1.0 : 0.0);
    if (p == nullptr) continue;
    series["position_n"].push_back(e(p->offset));
    series["position_e"].push_back(e(p->offset + 1));
    series["position_d"].push_back(e(p->offset + 2));
    const PartError position = PartOf(e, P, p->offset);
    distance.push_back(position.length);
    position_nees.push_back(position.nees);
    if (position.beyond) beyond.back() = 1.0;
    end_horizontal = e.segment<2>(p->offset).norm();
  }
  record->values.insert(record->values.end(),
                        {{"heading_rms", Rms(series["yaw"])},
                         {"attitude_rms", Rms(angle)},
                         {"attitude_nees", Mean(attitude_nees)},
                         {"outside_5_sigma", Mean(beyond)}});
  if (p == nullptr) return;
  record->values.insert(record->values.end(),
                        {{"position_rms", Rms(distance)},
                         {"position_max", Largest(distance)},
                         {"position_nees", Mean(position_nees)},
                         {"end_horizontal", end_horizontal}});
}

/// The rules that lower the grade, and the constants that are wrong.
void AddEvidence(const Dataset& dataset, const Solution& solution,
                 RunRecord* record) {
  constexpr double kWide = 5.0;
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

void JudgeSolution(const Dataset& dataset, const std::vector<double>& times,
                   const Solution& solution, RunRecord* record) {
  const std::vector<std::size_t> nodes = JudgedNodes(times, solution);
  std::vector<State> states;
  states.reserve(nodes.size());
  for (const std::size_t k : nodes) states.push_back(solution.states[k]);
  const std::vector<int> components =
      ComponentsWithTruth(dataset, solution.layout);
  double nis = 0.0, rows = 0.0;
  for (const ResidualRecord& residual : solution.residuals) {
    if (!residual.accepted || residual.withheld) continue;
    nis += residual.nis;
    rows += static_cast<double>(residual.residual.size());
  }
  record->values = {{kSeconds, solution.seconds},
                    {"nis_sum", nis},
                    {"nis_rows", rows},
                    {"states", static_cast<double>(components.size())}};
  record->grade = solution.grade;
  record->failed = !solution.converged;
  record->answered = solution.converged;
  AddEvidence(dataset, solution, record);
  JudgeNodes(solution, nodes, TrueStates(dataset, solution.layout, states),
             components, record);
}

}  // namespace hindsight
