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

/// None of what the method does not estimate.
std::optional<double> ValueOf(const RunRecord& record,
                              const std::string& name) {
  for (const auto& [own, value] : record.values) {
    if (own == name) return value;
  }
  return std::nullopt;
}

/// NaN is beyond every limit.
bool Exceeds(const RunRecord& record, const std::string& name, double limit) {
  const std::optional<double> value = ValueOf(record, name);
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

/// Records of one run for each table. `run` has the labels vehicle, fault,
/// size, method.
class Sorter {
 public:
  explicit Sorter(CaseRun* run) : run_(run) {}

  void Add(const RunRecord& run, const RunRecord* healthy, double lambda) {
    const bool is_faulty = healthy != nullptr;
    const bool wrong = IsWrong(run, healthy);
    const bool visible = is_faulty && lambda >= kVisible;
    const std::string group = !is_faulty
                                  ? (wrong ? "healthy, wrong" : "healthy")
                              : !run.answered ? "no answer"
                              : !wrong        ? "right"
                              : visible       ? "wrong, visible"
                                              : "wrong, not visible";
    const std::string& vehicle = run.labels[0];
    const std::string& method = run.labels[3];
    Add(run, kSummary, {vehicle, group, method}, {});
    std::vector<std::pair<std::string, double>> values = {
        {"wrong", wrong ? 1.0 : 0.0},
        {"visible", visible ? 1.0 : 0.0},
        {"noncentrality", lambda},
        {"wrong_and_usable", wrong && run.grade == Grade::kUsable ? 1.0 : 0.0}};
    for (const char* name : {"position_rms", "position_nees", "attitude_rms",
                             "attitude_nees", "outside_5_sigma"}) {
      const std::optional<double> value = ValueOf(run, name);
      if (value) values.emplace_back(name, *value);
    }
    Add(run, kFaults, run.labels, std::move(values));
    if (is_faulty && !(wrong && visible)) return;
    const std::vector<std::string> rules = RulesOf(run);
    const auto independent = std::count_if(
        rules.begin(), rules.end(),
        [](const std::string& rule) { return rule != kDerivedRule; });
    for (const std::string& rule : rules) {
      values = {{is_faulty ? "caught" : "healthy", 1.0}};
      if (is_faulty && independent == 1 && rule != kDerivedRule) {
        values.emplace_back("alone", 1.0);
      }
      Add(run, kEvidence, {vehicle, rule, method}, std::move(values));
    }
  }

 private:
  void Add(const RunRecord& run, std::size_t table,
           std::vector<std::string> labels,
           std::vector<std::pair<std::string, double>> values) {
    RunRecord& record = run_->records.emplace_back();
    record.table = table;
    record.labels = std::move(labels);
    record.seed = run.seed;
    record.grade = run.grade;
    record.failed = run.failed;
    record.answered = run.answered;
    record.values = std::move(values);
  }

  CaseRun* run_;
};

struct Tried {
  std::deque<RunRecord> cells;  ///< of the methods, in their order
  std::vector<NormalisedInnovation> innovations;
};

Tried Try(const Dataset& dataset, NavigationTrial trial,
          const std::vector<std::string>& labels, std::uint64_t seed) {
  Tried tried;
  trial.innovations = &tried.innovations;
  trial.best_of_run = true;
  CaseRun run = {labels, seed};
  NavigationTrialOf(trial)(dataset, &run);
  tried.cells = std::move(run.records);
  std::erase_if(tried.cells,
                [](const RunRecord& r) { return r.table != kCells; });
  return tried;
}

/// A recording that is refused before anything is estimated.
Tried Refused(const NavigationTrial& trial,
              const std::vector<std::string>& labels, std::uint64_t seed) {
  CaseRun run = {labels, seed};
  std::vector<std::string> methods = trial.methods;
  methods.emplace_back(kBestOfRun);
  for (const std::string& method : methods) {
    RunRecord* record = run.Add(kCells, {method});
    record->grade = Grade::kUnusable;
    record->Fail();
  }
  return {std::move(run.records), {}};
}

Tried TryTwin(const Dataset& healthy, const FaultyTwin& twin,
              const NavigationTrial& trial, const std::string& vehicle,
              std::uint64_t seed) {
  const std::vector<std::string> labels = {vehicle, twin.fault, twin.size};
  try {
    Dataset faulty = healthy;
    twin.apply(seed, &faulty);
    return Try(faulty, trial, labels, seed);
  } catch (const InputError&) {
    return Refused(trial, labels, seed);
  }
}

double Count(const RunCell& cell, const std::string& quantity,
             const TimeRange&) {
  return Sum(cell.Values(quantity));
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
  const auto count = [](const char* name, const char* title) {
    return Single(name, kPlain, title, "{:.0f}", name, Count);
  };
  StudyTable summary = {"summary",
                        {"vehicle", "class", "method"},
                        {GradesFigure(), FailedFigure()},
                        {}};
  StudyTable faults = {
      "faults", {"vehicle", "fault", "size", "method"}, {}, {}};
  faults.figures = {GradesFigure(),
                    count("wrong", "wrong"),
                    count("visible", "visible"),
                    count("wrong_and_usable", "wrong and\nusable"),
                    Single("noncentrality", kPlain, "lambda\nmedian", "{:.3g}",
                           "noncentrality", OfRuns<Rank50>),
                    Single("position_rms", kMetres, "position\nrms [m]",
                           "{:.3g}", "position_rms", OfRuns<Rms>),
                    Single("position_nees", kPlain, "NEES (3)\nposition",
                           "{:.3g}", "position_nees", OfRuns<Mean>),
                    Single("attitude_nees", kPlain, "NEES (3)\nattitude",
                           "{:.3g}", "attitude_nees", OfRuns<Mean>),
                    FailedFigure()};
  StudyTable evidence = {"evidence", {"vehicle", "rule", "method"}, {}, {}};
  evidence.figures = {count("caught", "wrong runs\ncaught"),
                      count("alone", "alone"),
                      count("healthy", "healthy\nruns")};
  return {summary, faults, evidence};
}

Trial GradeTrial(const NavigationTrial& trial,
                 const std::vector<FaultyTwin>& twins) {
  return [trial, twins](const Dataset& healthy, CaseRun* run) {
    const std::string& vehicle = run->labels.back();
    const std::uint64_t seed = run->seed;
    Sorter sorter(run);
    const Tried well = Try(healthy, trial, {vehicle, "none", ""}, seed);
    for (const RunRecord& cell : well.cells) sorter.Add(cell, nullptr, 0.0);
    for (const FaultyTwin& twin : twins) {
      const Tried tried = TryTwin(healthy, twin, trial, vehicle, seed);
      const double lambda = Noncentrality(well.innovations, tried.innovations);
      for (std::size_t i = 0; i < tried.cells.size(); ++i) {
        sorter.Add(tried.cells[i], &well.cells[i], lambda);
      }
    }
  };
}

}  // namespace hindsight
