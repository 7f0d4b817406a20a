#include "problems/navigation_trial.h"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "evaluation/grade.h"
#include "evaluation/statistics.h"
#include "evaluation/true_states.h"
#include "problems/method.h"
#include "problems/reconstruction.h"

namespace hindsight {
namespace {

constexpr double kTimeTolerance = 1e-6;

/// The nodes of a solution at which it is judged.
std::vector<std::size_t> JudgedNodes(const std::vector<double>& times,
                                     const Solution& solution) {
  std::vector<std::size_t> nodes;
  std::size_t next = 0;
  for (std::size_t k = 0; k < solution.states.size(); ++k) {
    const double t = solution.states[k].t;
    while (next < times.size() && times[next] < t - kTimeTolerance) ++next;
    if (times.empty() ||
        (next < times.size() && times[next] <= t + kTimeTolerance)) {
      nodes.push_back(k);
    }
  }
  return nodes;
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

void AddConstants(const Dataset& dataset, const Solution& solution,
                  const std::string& method, CaseRun* run) {
  using Verdict = ConstantEstimate::Verdict;
  for (const ConstantEstimate& c : solution.constants) {
    const auto truth = dataset.true_constants.find(c.name);
    if (truth == dataset.true_constants.end()) continue;
    RunRecord* record = run->Add(kConstants, {method, c.name, c.unit});
    record->answered = solution.converged;
    const double error = c.value - truth->second;
    record->values = {
        {"prior_sigma", c.prior_sigma},
        {"sigma", c.sigma},
        {"error", error},
        {"nees", (error / c.sigma) * (error / c.sigma)},
        {"observed", c.verdict == Verdict::kObserved ? 1.0 : 0.0},
        {"unobserved", c.verdict == Verdict::kUnobserved ? 1.0 : 0.0}};
  }
}

/// Streams that were withheld or silent over the same span:
/// "gnss+gnss_velocity".
using OutageSpans = std::map<std::pair<double, double>, std::string>;

OutageSpans SpansOf(const Dataset& dataset,
                    const std::vector<SilentSpan>& silent_spans) {
  OutageSpans spans;
  const auto add = [&](double begin, double end, const std::string& sensor) {
    std::string& sensors = spans[{begin, end}];
    sensors += (sensors.empty() ? "" : "+") + sensor;
  };
  for (const Outage& outage : dataset.outages) {
    const auto i = static_cast<std::size_t>(outage.sensor);
    add(outage.t_begin, outage.t_end, dataset.streams[i].sensor.name);
  }
  for (const SilentSpan& silent : silent_spans) {
    if (silent.t_begin <= dataset.truth.front().t ||
        silent.t_end >= dataset.truth.back().t) {
      continue;
    }
    add(silent.t_begin, silent.t_end, silent.sensor);
  }
  return spans;
}

void AddOutages(const OutageSpans& spans, const RunRecord& judged,
                const std::string& method, CaseRun* run) {
  if (!judged.series.contains("position_n")) return;
  for (const auto& [span, sensors] : spans) {
    double horizontal = -1.0, vertical = 0.0;
    for (std::size_t k = 0; k < judged.t.size(); ++k) {
      if (judged.t[k] < span.first || judged.t[k] > span.second) continue;
      horizontal =
          std::max(horizontal, std::hypot(judged.series.at("position_n")[k],
                                          judged.series.at("position_e")[k]));
      vertical =
          std::max(vertical, std::abs(judged.series.at("position_d")[k]));
    }
    if (horizontal < 0.0) continue;
    const double length = std::round(10.0 * (span.second - span.first)) / 10.0;
    RunRecord* record =
        run->Add(kOutages, {fmt::format("{:g} s", length), sensors, method});
    record->answered = judged.answered;
    record->values = {{"horizontal", horizontal}, {"vertical", vertical}};
  }
}

/// The pairs whose agreement says something about the methods.
constexpr std::pair<const char*, const char*> kCompared[] = {
    {"two_filter", "rts"},
    {"two_filter_conventional", "two_filter"},
    {"two_filter_euler", "two_filter"},
    {"iterated", "two_filter"},
    {"batch", "iterated"}};

const Solution* Find(const std::vector<Solution>& solutions,
                     const std::string& method) {
  for (const Solution& solution : solutions) {
    if (solution.method == method) return &solution;
  }
  return nullptr;
}

void AddAgreement(const Solution& a, const Solution& b,
                  const NavigationTrial& trial, CaseRun* run) {
  const double first_leg_end =
      trial.leg_ends.empty() ? 0.0 : trial.leg_ends.front();
  double position = 0.0, attitude = 0.0, after_first_leg = 0.0;
  for (std::size_t k = 0; k < std::min(a.states.size(), b.states.size()); ++k) {
    const double distance = (a.states[k].p_e - b.states[k].p_e).norm();
    position = std::max(position, distance);
    attitude =
        std::max(attitude, a.states[k].q_eb.angularDistance(b.states[k].q_eb));
    if (a.states[k].t > first_leg_end) {
      after_first_leg = std::max(after_first_leg, distance);
    }
  }
  run->Add(kAgreement, {a.method, b.method})->values = {
      {"position", position},
      {"attitude", attitude},
      {"position_after_first_leg", after_first_leg}};
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

/// Stamps of the truth at which a method is judged; empty: at all its nodes.
std::vector<double> JudgedTimes(const NavigationTrial& trial,
                                const Dataset& dataset) {
  if (trial.judged_every == 0.0) return {};
  const double apart = trial.judged_every - kTimeTolerance;
  std::vector<double> times;
  double next = dataset.truth.front().t + apart;
  const double end = std::min(dataset.truth.back().t - apart, trial.judged_to);
  for (const TruthPoint& truth : dataset.truth) {
    if (truth.t < next || truth.t > end) continue;
    times.push_back(truth.t);
    next = truth.t + apart;
  }
  return times;
}

void Judge(const Dataset& dataset, const std::vector<double>& times,
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

/// The cell of the run as a whole: that of its best method, with the grade that
/// `run` gives it beside the others.
void AddBest(std::vector<Solution> solutions,
             const std::vector<double>& judged_times, const Dataset& dataset,
             CaseRun* run) {
  RunRecord* record = run->Add(kCells, {kBestOfRun});
  record->grade = Grade::kUnusable;
  record->failed = true;
  record->answered = false;
  if (solutions.empty()) return;
  ShareDisagreements(&solutions);
  const Solution& best = Best(solutions);
  Judge(dataset, judged_times, best, record);
}

}  // namespace

Trial NavigationTrialOf(const NavigationTrial& trial) {
  return [trial](const Dataset& dataset, CaseRun* run) {
    ReconstructionOptions options;
    options.node_times = JudgedTimes(trial, dataset);
    options.attitude_alone = std::all_of(
        trial.methods.begin(), trial.methods.end(),
        [](const auto& name) { return MethodOf(name).attitude_alone(); });
    std::unique_ptr<Reconstruction> reconstruction;
    std::vector<Solution> solutions;
    for (const std::string& method : trial.methods) {
      run->Try({method}, [&](RunRecord* record) {
        record->grade = Grade::kUnusable;
        if (!reconstruction) {
          reconstruction = std::make_unique<Reconstruction>(dataset, options);
        }
        Solution& solution =
            solutions.emplace_back(reconstruction->Run(method));
        if (options.attitude_alone && !options.node_times.empty()) {
          solution = reconstruction->Sample(solution, options.node_times);
        }
        Judge(dataset, options.node_times, solution, record);
        record->values.insert(record->values.end(), trial.values.begin(),
                              trial.values.end());
        AddConstants(dataset, solution, method, run);
        AddOutages(SpansOf(dataset, trial.silent_spans), *record, method, run);
      });
    }
    if (trial.innovations != nullptr && reconstruction) {
      try {
        *trial.innovations = reconstruction->Innovations();
      } catch (const EstimationError&) {
        trial.innovations->clear();
      }
    }
    for (const auto& [first, second] : kCompared) {
      const Solution* a = Find(solutions, first);
      const Solution* b = Find(solutions, second);
      if (a != nullptr && b != nullptr) AddAgreement(*a, *b, trial, run);
    }
    if (trial.best_of_run) {
      AddBest(std::move(solutions), options.node_times, dataset, run);
    }
  };
}

}  // namespace hindsight
