#include "problems/study_result.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "base/error.h"

namespace hindsight {
namespace {

std::string RefusalOf(const RunRecord& record) {
  std::string text;
  for (const std::string& label : record.labels) {
    if (!label.empty()) text += label + ", ";
  }
  return text + "seed " + std::to_string(record.seed) + ": " + record.refusal;
}

}  // namespace

void CaseRuns::Add(int run, std::vector<RunRecord> of_run) {
  FoldTree::Node node = {.level = 0, .index = run, .cells = {}};
  for (RunRecord& record : of_run) {
    if (record.answered && !record.t.empty()) {
      node.cells[{record.table, record.labels}] =
          FoldOfRun(std::move(record.t), std::move(record.series));
    }
    record.t.clear();
    record.series.clear();
  }
  folds.Add(std::move(node));
  records[run] = std::move(of_run);
}

void StudyShard::Append(StudyShard next) {
  if (next.begin != end || next.cases.size() != cases.size()) {
    throw std::invalid_argument("the shards are not those of one study");
  }
  end = next.end;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    cases[i].records.merge(next.cases[i].records);
    for (const auto& [begin, node] : next.cases[i].folds.nodes()) {
      cases[i].folds.Add(node);
    }
  }
}

StudyResult::StudyResult(const std::vector<StudyTable>& of,
                         const StudyShard& shard, std::size_t finished)
    : complete(finished == shard.cases.size()), tables(of), rows(of.size()) {
  if (finished > 0) {
    runs = shard.end;
  } else if (shard.cases.size() == 1) {
    while (shard.cases[0].records.contains(runs)) ++runs;
    finished = 1;
  }
  for (std::size_t i = 0; i < finished; ++i) Add(shard.cases[i], runs);
}

bool StudyResult::refused() const {
  return !refusals.empty() &&
         std::ranges::none_of(records, &RunRecord::answered);
}

void StudyResult::RequireAnswer() const {
  if (refused()) throw InputError(refusals.front());
}

void StudyResult::Add(const CaseRuns& one, int first_runs) {
  std::vector<RunRecord> added;
  for (auto run = one.records.begin();
       run != one.records.end() && run->first < first_runs; ++run) {
    added.insert(added.end(), run->second.begin(), run->second.end());
  }
  const CellFolds folds = one.folds.First(first_runs);
  for (std::size_t i = 0; i < tables.size(); ++i) {
    std::ranges::move(Summarize(tables[i], i, added, folds),
                      std::back_inserter(rows[i]));
  }
  for (RunRecord& record : added) {
    if (!record.refusal.empty()) refusals.push_back(RefusalOf(record));
    records.push_back(std::move(record));
  }
}

}  // namespace hindsight
