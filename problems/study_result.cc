#include "problems/study_result.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <stdexcept>
#include <utility>

#include "base/error.h"

namespace hindsight {
namespace {

bool StartsWith(const std::vector<std::string>& labels,
                const std::vector<std::string>& first) {
  return labels.size() >= first.size() &&
         std::equal(first.begin(), first.end(), labels.begin());
}

/// Puts a failed run of every method that other seeds of the case have in the
/// place of each refused recording; "-" is the method where all were refused.
void SpreadRefusals(std::size_t label_count, std::vector<RunRecord>* job) {
  const auto middle = std::stable_partition(
      job->begin(), job->end(),
      [](const RunRecord& record) { return record.table != kRefused; });
  const std::vector<RunRecord> refused(middle, job->end());
  job->erase(middle, job->end());
  std::set<std::vector<std::string>> cells;
  for (const RunRecord& record : *job) {
    if (record.table == 0) cells.insert(record.labels);
  }
  for (RunRecord record : refused) {
    record.table = 0;
    const std::vector<std::string> of_case = record.labels;
    record.labels.resize(label_count, "-");
    if (cells.empty()) job->push_back(record);
    for (const std::vector<std::string>& labels : cells) {
      if (!StartsWith(labels, of_case)) continue;
      record.labels = labels;
      job->push_back(record);
    }
  }
}

std::string RefusalOf(const RunRecord& record) {
  std::string text;
  for (const std::string& label : record.labels) {
    if (!label.empty()) text += label + ", ";
  }
  return text + "seed " + std::to_string(record.seed) + ": " + record.refusal;
}

}  // namespace

void JobRuns::Add(int run, std::vector<RunRecord> of_run,
                  const std::vector<StudyTable>& tables) {
  FoldTree::Node node = {.level = 0, .index = run, .cells = {}};
  for (RunRecord& record : of_run) {
    if (record.table == kRefused) continue;
    if (!tables[record.table].folds_series) continue;
    if (record.answered && !record.t.empty()) {
      node.cells[{record.table, record.labels}] =
          FoldOfRun(std::move(record.t), std::move(record.series));
    }
    record.t = {};
    record.series = {};
  }
  folds.Add(std::move(node));
  records[run] = std::move(of_run);
}

StudyResult::StudyResult(const std::vector<StudyTable>& of)
    : tables(of), rows(of.size()) {}

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

void StudyResult::Add(const JobRuns& job, int first_runs) {
  std::vector<RunRecord> added;
  for (auto run = job.records.begin();
       run != job.records.end() && run->first < first_runs; ++run) {
    added.insert(added.end(), run->second.begin(), run->second.end());
  }
  for (const RunRecord& record : added) {
    if (!record.refusal.empty()) refusals.push_back(RefusalOf(record));
  }
  SpreadRefusals(tables[0].labels.size(), &added);
  const CellFolds folds = job.folds.First(first_runs);
  for (std::size_t i = 0; i < tables.size(); ++i) {
    std::ranges::move(Summarize(tables[i], i, added, folds),
                      std::back_inserter(rows[i]));
  }
  for (RunRecord& record : added) {
    record.t.clear();
    record.series.clear();
    records.push_back(std::move(record));
  }
}

void StudyResult::RequireAnswer() const {
  if (!answered() && !refusals.empty()) throw InputError(refusals.front());
}

StudyResult MergeShards(const std::vector<StudyTable>& tables,
                        std::vector<StudyShard> shards) {
  std::sort(shards.begin(), shards.end(),
            [](const StudyShard& a, const StudyShard& b) {
              return a.begin < b.begin;
            });
  StudyResult result(tables);
  for (const StudyShard& shard : shards) {
    if (shard.begin != result.runs ||
        shard.jobs.size() != shards.front().jobs.size()) {
      throw std::invalid_argument("the shards are not those of one study");
    }
    result.runs = shard.end;
  }
  for (std::size_t i = 0; i < shards.front().jobs.size(); ++i) {
    JobRuns all;
    for (StudyShard& shard : shards) {
      all.records.merge(shard.jobs[i].records);
      for (const auto& [begin, node] : shard.jobs[i].folds.nodes()) {
        all.folds.Add(node);
      }
      shard.jobs[i] = {};
    }
    result.Add(all, result.runs);
  }
  result.RequireAnswer();
  return result;
}

}  // namespace hindsight
