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

bool StudyResult::answered() const {
  return std::any_of(records.begin(), records.end(),
                     [](const RunRecord& record) { return record.answered; });
}

double StudyResult::Value(const std::vector<std::string>& labels,
                          const std::string& name, std::size_t table) const {
  return FigureOf(tables.at(table), Row(labels, table), name).value();
}

const FigureRow& StudyResult::Row(const std::vector<std::string>& labels,
                                  std::size_t table) const {
  for (const FigureRow& row : rows.at(table)) {
    if (row.labels == labels) return row;
  }
  throw std::out_of_range("no row of that case and method");
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

void StudyResult::RequireAnswer() const {
  if (!answered() && !refusals.empty()) throw InputError(refusals.front());
}

StudyResult MergeShards(const std::vector<StudyTable>& tables,
                        std::vector<StudyShard> shards) {
  std::ranges::sort(shards, {}, &StudyShard::begin);
  StudyShard all;
  all.cases.resize(shards.front().cases.size());
  for (StudyShard& shard : shards) {
    if (shard.begin != all.end || shard.cases.size() != all.cases.size()) {
      throw std::invalid_argument("the shards are not those of one study");
    }
    all.end = shard.end;
    for (std::size_t i = 0; i < all.cases.size(); ++i) {
      all.cases[i].records.merge(shard.cases[i].records);
      for (const auto& [begin, node] : shard.cases[i].folds.nodes()) {
        all.cases[i].folds.Add(node);
      }
      shard.cases[i] = {};
    }
  }
  StudyResult result(tables, all, all.cases.size());
  result.RequireAnswer();
  return result;
}

}  // namespace hindsight
