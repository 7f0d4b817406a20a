#include "problems/grade_trial.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <optional>
#include <utility>

#include "base/error.h"
#include "evaluation/statistics.h"

namespace hindsight {
namespace {

constexpr std::size_t kSummary = 0;
constexpr std::size_t kFaults = 1;
constexpr std::size_t kEvidence = 2;
constexpr char kRulePrefix[] = "rule:";
/// It says which sensor, where another rule says that something does not fit.
constexpr const char* kDerivedRule = "contradiction";

/// NaN is beyond every limit.
bool Exceeds(const RunRecord& record, const std::string& name, double limit) {
  const std::optional<double> value = record.Find(name);
  return value && !(*value <= limit);
}

/// Whether an answer is wrong, beside the one of the healthy twin.
bool IsWrong(const RunRecord& run, const RunRecord* healthy) {
  if (!run.answered) return false;
  if (Exceeds(run, "position_nees", kWrongNees) ||
      Exceeds(run, "attitude_nees", kWrongNees) ||
      Exceeds(run, "constants_beyond_5_sigma", 0.0)) {
    return true;
  }
  return Exceeds(run, "outside_5_sigma", kWrongShare) &&
         (healthy == nullptr || !healthy->answered ||
          !Exceeds(*healthy, "outside_5_sigma", kWrongShare));
}

std::vector<std::string> RulesOf(const RunRecord& run) {
  std::vector<std::string> rules;
  for (const auto& [name, value] : run.values) {
    if (name.starts_with(kRulePrefix)) {
      rules.push_back(name.substr(sizeof(kRulePrefix) - 1));
    }
  }
  return rules;
}

/// A cell, whose labels are vehicle, fault, size and method, into all tables;
/// `healthy` is that of the twin, nullptr of the healthy recording itself.
void Sort(const RunRecord& cell, const RunRecord* healthy, double lambda,
          CaseRun* run) {
  const std::string& vehicle = cell.labels[0];
  const std::string& method = cell.labels[3];
  const auto add = [&](std::size_t table,
                       const std::vector<std::string>& labels) {
    RunRecord& record = run->records.emplace_back(cell);
    record.table = table;
    record.labels = labels;
    record.values.clear();
    return &record;
  };
  const bool is_faulty = healthy != nullptr;
  const bool wrong = IsWrong(cell, healthy);
  const bool visible = is_faulty && lambda >= kVisible;
  add(kSummary, {vehicle,
                 !is_faulty       ? (wrong ? "healthy, wrong" : "healthy")
                 : !cell.answered ? "no answer"
                 : !wrong         ? "right"
                 : visible        ? "wrong, visible"
                                  : "wrong, not visible",
                 method});
  RunRecord* fault = add(kFaults, cell.labels);
  fault->values = cell.values;
  fault->values.insert(fault->values.end(),
                       {{"wrong", wrong ? 1.0 : 0.0},
                        {"visible", visible ? 1.0 : 0.0},
                        {"noncentrality", lambda},
                        {"wrong_and_usable",
                         wrong && cell.grade == Grade::kUsable ? 1.0 : 0.0}});
  if (is_faulty && !(wrong && visible)) return;
  const std::vector<std::string> rules = RulesOf(cell);
  const auto independent =
      std::ssize(rules) - std::ranges::count(rules, kDerivedRule);
  for (const std::string& rule : rules) {
    RunRecord* evidence = add(kEvidence, {vehicle, rule, method});
    evidence->values = {{is_faulty ? "caught" : "healthy", 1.0}};
    if (is_faulty && independent == 1 && rule != kDerivedRule) {
      evidence->values.emplace_back("alone", 1.0);
    }
  }
}

struct Tried {
  std::deque<RunRecord> cells;  ///< of the methods, in their order
  std::vector<NormalisedInnovation> innovations;
};

Tried Try(const Dataset& dataset, NavigationTrial trial, CaseRun run) {
  Tried tried;
  trial.innovations = &tried.innovations;
  trial.best_of_run = true;
  NavigationTrialOf(trial).run(dataset, &run);
  for (RunRecord& record : run.records) {
    if (record.table != kCells) continue;
    record.t.clear();
    record.series.clear();
    tried.cells.push_back(std::move(record));
  }
  return tried;
}

/// Without an answer of any method where the recording is refused before
/// anything is estimated.
Tried TryTwin(Dataset dataset, const FaultyTwin& twin,
              const NavigationTrial& trial, CaseRun run) {
  try {
    twin.apply(run.seed, &dataset);
    return Try(dataset, trial, run);
  } catch (const InputError&) {
    std::vector<std::string> methods = trial.methods;
    methods.emplace_back(kBestOfRun);
    for (const std::string& method : methods) {
      RunRecord* record = run.Add(kCells, {method});
      record->grade = Grade::kUnusable;
      record->Fail();
    }
    return {std::move(run.records), {}};
  }
}

/// The innovations by which a fault is measured.
std::vector<NormalisedInnovation> InnovationsOfFault(
    const Dataset& healthy, const FaultyTwin& twin, NavigationTrial trial,
    const CaseRun& run, std::vector<NormalisedInnovation> own) {
  if (!twin.with_errors_kept) return own;
  std::optional<Dataset> kept = twin.with_errors_kept(run.seed, healthy);
  if (!kept) return own;
  trial.methods.resize(1);
  const FaultyTwin ready = {
      twin.fault, twin.size,
      [&](std::uint64_t, Dataset* dataset) { *dataset = *std::move(kept); }};
  return TryTwin(healthy, ready, trial, run).innovations;
}

}  // namespace

double Noncentrality(const std::vector<NormalisedInnovation>& healthy,
                     const std::vector<NormalisedInnovation>& faulty) {
  std::map<std::pair<int, std::size_t>, const RowVector*> known;
  for (const NormalisedInnovation& innovation : healthy) {
    // Rests of the twins are no pairs.
    if (innovation.index == NormalisedInnovation::kOwn) continue;
    known[{innovation.sensor, innovation.index}] = &innovation.white;
  }
  double sum = 0.0;
  bool any = false;
  for (const NormalisedInnovation& innovation : faulty) {
    const auto twin = known.find({innovation.sensor, innovation.index});
    if (twin == known.end() ||
        twin->second->size() != innovation.white.size()) {
      continue;
    }
    sum += (innovation.white - *twin->second).squaredNorm();
    any = true;
  }
  return any ? std::sqrt(sum) : std::numeric_limits<double>::infinity();
}

std::vector<StudyTable> GradeTables() {
  StudyTable summary = {"summary", {"vehicle", "class", "method"}};
  summary.AddGrades();
  summary.Add({FailedFigure()});
  StudyTable faults = {"faults", {"vehicle", "fault", "size", "method"}};
  faults.AddGrades();
  faults.Add({{"wrong", kPlain, OfRuns(Sum)},
              {"visible", kPlain, OfRuns(Sum)},
              {"wrong_and_usable", kPlain, OfRuns(Sum)},
              {"noncentrality", kPlain, OfRuns(Rank50)},
              {"position_rms", kMetres, OfRuns(Rms)},
              {"position_nees", kPlain, OfRuns(Mean)},
              {"attitude_nees", kPlain, OfRuns(Mean)},
              FailedFigure()});
  StudyTable evidence = {"evidence", {"vehicle", "rule", "method"}};
  evidence.Add({{"caught", kPlain, OfRuns(Sum)},
                {"alone", kPlain, OfRuns(Sum)},
                {"healthy", kPlain, OfRuns(Sum)}});
  return {summary, faults, evidence};
}

Trial GradeTrial(const NavigationTrial& trial,
                 const std::vector<FaultyTwin>& twins) {
  std::vector<std::vector<std::string>> refused = {{"no answer", kBestOfRun}};
  for (const std::string& method : trial.methods) {
    refused.push_back({"no answer", method});
  }
  return {refused, [trial, twins](const Dataset& healthy, CaseRun* run) {
            const std::string vehicle = run->labels.back();
            const Tried well =
                Try(healthy, trial, {{vehicle, "none", ""}, run->seed});
            for (const RunRecord& cell : well.cells)
              Sort(cell, nullptr, 0.0, run);
            for (const FaultyTwin& twin : twins) {
              const CaseRun own = {{vehicle, twin.fault, twin.size}, run->seed};
              const Tried tried = TryTwin(healthy, twin, trial, own);
              const double lambda = Noncentrality(
                  well.innovations, InnovationsOfFault(healthy, twin, trial,
                                                       own, tried.innovations));
              for (std::size_t i = 0; i < tried.cells.size(); ++i) {
                Sort(tried.cells[i], &well.cells[i], lambda, run);
              }
            }
          }};
}

}  // namespace hindsight
