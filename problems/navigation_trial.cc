#include "problems/navigation_trial.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "evaluation/grade.h"
#include "evaluation/series_fold.h"
#include "problems/method.h"
#include "problems/reconstruction.h"

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

double LengthOf(const TruthSeries& truth) {
  double length = 0.0;
  std::optional<Eigen::Vector3d> before;
  for (const TruthPoint& point : truth) {
    if (before && point.p_e) length += (*point.p_e - *before).norm();
    before = point.p_e;
  }
  return length;
}

/// The rules that lower the grade, and how many constants are wrong.
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
    if (std::abs(c.value - truth->second) > 5.0 * c.sigma) beyond += 1.0;
  }
  record->values.emplace_back("constants_beyond_5_sigma", beyond);
}

/// Into a cell, at those of `times` [s] that are nodes of the solution.
StateErrors Judge(const StudyTable& cells, const Dataset& dataset,
                  const std::vector<double>& times, const Solution& solution,
                  RunRecord* record) {
  StateErrors errors =
      ErrorsOf(dataset, solution, JudgedNodes(times, solution));
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
  cells.Record(errors, record);
  if (const auto end = record->Find("end_horizontal")) {
    record->values.emplace_back("end_drift", *end / LengthOf(dataset.truth));
  }
  return errors;
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
        {"states", 1.0},
        {"observed", c.verdict == Verdict::kObserved ? 1.0 : 0.0},
        {"unobserved", c.verdict == Verdict::kUnobserved ? 1.0 : 0.0}};
  }
}

/// Streams that were withheld or silent over the same span:
/// "gnss+gnss_velocity".
using OutageSpans = std::map<std::pair<double, double>, std::string>;

OutageSpans SpansOf(const Dataset& dataset) {
  OutageSpans spans;
  const auto add = [&](const Outage& outage) {
    const auto i = static_cast<std::size_t>(outage.sensor);
    std::string& sensors = spans[{outage.t_begin, outage.t_end}];
    sensors += (sensors.empty() ? "" : "+") + dataset.streams[i].sensor.name;
  };
  std::ranges::for_each(dataset.outages, add);
  for (const Outage& silence : dataset.silences) {
    if (silence.t_begin > dataset.truth.front().t &&
        silence.t_end < dataset.truth.back().t) {
      add(silence);
    }
  }
  return spans;
}

void AddOutages(const OutageSpans& spans, const StateErrors& errors,
                bool answered, const std::string& method, CaseRun* run) {
  if (errors.position.e.empty()) return;
  for (const auto& [span, sensors] : spans) {
    double horizontal = -1.0, vertical = 0.0;
    for (std::size_t k = 0; k < errors.t.size(); ++k) {
      if (errors.t[k] < span.first || errors.t[k] > span.second) continue;
      const Eigen::Vector3d& e = errors.position.e[k];
      horizontal = std::max(horizontal, e.head<2>().norm());
      vertical = std::max(vertical, std::abs(e.z()));
    }
    if (horizontal < 0.0) continue;
    const double length = std::round(10.0 * (span.second - span.first)) / 10.0;
    RunRecord* record =
        run->Add(kOutages, {fmt::format("{:g} s", length), sensors, method});
    record->answered = answered;
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

/// Stamps of the truth at which a method is judged; empty: at all its nodes.
std::vector<double> JudgedTimes(const NavigationTrial& trial,
                                const Dataset& dataset) {
  if (trial.judged_every == 0.0) return {};
  constexpr double kTolerance = 1e-6;
  const double apart = trial.judged_every - kTolerance;
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

/// The cell of the run as a whole: that of its best method, with the grade that
/// `run` gives it beside the others.
void AddBest(const StudyTable& cells, std::vector<Solution> solutions,
             const std::vector<double>& judged_times, const Dataset& dataset,
             CaseRun* run) {
  RunRecord* record = run->Add(kCells, {kBestOfRun});
  record->grade = Grade::kUnusable;
  record->Fail();
  if (solutions.empty()) return;
  ShareDisagreements(&solutions);
  ShareFindings(&solutions);
  Judge(cells, dataset, judged_times, Best(solutions), record);
}

}  // namespace

Trial NavigationTrialOf(const NavigationTrial& trial) {
  std::vector<std::string> names = trial.methods;
  if (trial.best_of_run) names.emplace_back(kBestOfRun);
  return {
      Named(names), [trial](const Dataset& dataset, CaseRun* run) {
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
              reconstruction =
                  std::make_unique<Reconstruction>(dataset, options);
            }
            Solution& solution =
                solutions.emplace_back(reconstruction->Run(method));
            if (options.attitude_alone && !options.node_times.empty()) {
              solution = reconstruction->Sample(solution, options.node_times);
            }
            const StateErrors errors = Judge(
                trial.cells, dataset, options.node_times, solution, record);
            AddConstants(dataset, solution, method, run);
            AddOutages(SpansOf(dataset), errors, solution.converged, method,
                       run);
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
          AddBest(trial.cells, std::move(solutions), options.node_times,
                  dataset, run);
        }
      }};
}

}  // namespace hindsight
