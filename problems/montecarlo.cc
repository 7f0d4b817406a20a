#include "problems/montecarlo.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>

#include "base/error.h"

namespace hindsight {
namespace {

/// Table of the recordings that were refused as a whole, until all seeds are in.
constexpr std::size_t kRefused = std::numeric_limits<std::size_t>::max();

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

/// Of all cases on one seed.
std::vector<RunRecord> RunCases(const std::vector<Case>& cases,
                                const std::vector<Recording>& recordings,
                                std::uint64_t seed) {
  std::vector<RunRecord> out;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    CaseRun run(cases[i].labels, seed, &out);
    const std::size_t before = out.size();
    try {
      cases[i].trial(recordings[i](seed), &run);
    } catch (const InputError& error) {
      out.resize(before);
      RunRecord* record = run.Add(kRefused, {});
      record->failed = true;
      record->answered = false;
      record->refusal = error.what();
    }
  }
  return out;
}

/// Adds what a job made of its runs 0 to runs - 1 to a result.
void Take(const JobRuns& job, int runs, StudyResult* to) {
  std::vector<RunRecord> records;
  for (auto run = job.records.begin();
       run != job.records.end() && run->first < runs; ++run) {
    records.insert(records.end(), run->second.begin(), run->second.end());
  }
  for (const RunRecord& record : records) {
    if (!record.refusal.empty()) to->refusals.push_back(RefusalOf(record));
  }
  SpreadRefusals(to->tables[0].labels.size(), &records);
  const CellFolds folds = job.folds.First(runs);
  for (std::size_t i = 0; i < to->tables.size(); ++i) {
    std::vector<FigureRow> of_job = Summarize(to->tables[i], i, records, folds);
    std::move(of_job.begin(), of_job.end(), std::back_inserter(to->rows[i]));
  }
  for (RunRecord& record : records) {
    record.t.clear();
    record.series.clear();
    to->records.push_back(std::move(record));
  }
}

StudyResult EmptyResult(const std::vector<StudyTable>& tables) {
  StudyResult result;
  result.tables = tables;
  result.rows.resize(tables.size());
  return result;
}

/// Throws the first refusal if nothing else is there.
StudyResult RequireAnswer(StudyResult result) {
  if (!result.answered() && !result.refusals.empty()) {
    throw InputError(result.refusals.front());
  }
  return result;
}

/// The table as it grows, set by the threads that do the work and read by
/// others meanwhile.
class GrowingTable {
 public:
  GrowingTable(Study study, int runs)
      : study_(std::move(study)),
        runs_(runs),
        jobs_so_far_(EmptyResult(study_.tables)) {}

  void Set(int run, std::vector<RunRecord> records) {
    const std::lock_guard lock(mutex_);
    of_job_.Add(run, std::move(records), study_.tables);
  }

  /// All seeds of the job are in: their figures stay, their series go.
  void EndJob() {
    const std::lock_guard lock(mutex_);
    Take(of_job_, runs_, &jobs_so_far_);
    ++jobs_;
    of_job_ = {};
  }

  StudyResult SoFar() const {
    const std::lock_guard lock(mutex_);
    StudyResult result = jobs_so_far_;
    result.complete = jobs_ == study_.jobs.size();
    result.runs = jobs_ > 0 ? runs_ : 0;
    if (study_.jobs.size() == 1 && !result.complete) {
      result.runs = 0;
      while (of_job_.records.contains(result.runs)) ++result.runs;
      Take(of_job_, result.runs, &result);
    }
    return result;
  }

 private:
  Study study_;
  int runs_;
  mutable std::mutex mutex_;
  JobRuns of_job_;
  std::size_t jobs_ = 0;
  StudyResult jobs_so_far_;  ///< of those that are done
};

/// Calls work(i) for every run from begin on to before end on so many threads.
/// The first exception stops the rest and is thrown.
void ForEachRun(int begin, int end, int thread_count,
                const std::function<void(int i)>& work) {
  std::atomic<int> next = begin;
  std::mutex mutex;
  std::exception_ptr thrown;
  const auto run = [&] {
    for (int i = next++; i < end; i = next++) {
      try {
        work(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!thrown) thrown = std::current_exception();
        next = end;
      }
    }
  };
  std::vector<std::thread> threads;
  for (int i = 1; i < thread_count; ++i) threads.emplace_back(run);
  run();
  for (std::thread& thread : threads) thread.join();
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace

void CaseRun::Try(const std::vector<std::string>& method,
                  const std::function<void(RunRecord*)>& work) {
  RunRecord record;
  const auto fail = [&](const std::string& refusal) {
    record.failed = true;
    record.answered = false;
    record.refusal = refusal;
  };
  try {
    work(&record);
  } catch (const EstimationError&) {
    fail("");
  } catch (const InputError& error) {
    fail(error.what());
  }
  RunRecord* added = Add(0, method);
  record.labels = std::move(added->labels);
  record.seed = seed_;
  *added = std::move(record);
}

RunRecord* CaseRun::Add(std::size_t table,
                        const std::vector<std::string>& labels) {
  RunRecord& record = out_.emplace_back();
  record.table = table;
  record.labels = labels_;
  record.labels.insert(record.labels.end(), labels.begin(), labels.end());
  record.seed = seed_;
  return &record;
}

std::function<SeedRun()> JobOf(const std::vector<Case>& cases) {
  return [cases]() -> SeedRun {
    std::vector<Recording> recordings;
    for (const Case& one : cases) {
      try {
        recordings.push_back(one.prepare());
      } catch (const InputError& error) {
        recordings.emplace_back(
            [error](std::uint64_t) -> Dataset { throw error; });
      }
    }
    return [cases, recordings](std::uint64_t seed) {
      return RunCases(cases, recordings, seed);
    };
  };
}

bool StudyResult::answered() const {
  return std::any_of(records.begin(), records.end(),
                     [](const RunRecord& record) { return record.answered; });
}

double StudyResult::Value(const std::vector<std::string>& labels,
                          const std::string& name, std::size_t table) const {
  return FigureOf(tables.at(table), rows.at(table), labels, name);
}

const FigureRow& StudyResult::Row(const std::vector<std::string>& labels,
                                  std::size_t table) const {
  for (const FigureRow& row : rows.at(table)) {
    if (row.labels == labels) return row;
  }
  throw std::out_of_range("no row of that case and method");
}

void JobRuns::Add(int run, std::vector<RunRecord> of_run,
                  const std::vector<StudyTable>& tables) {
  FoldTree::Node node = {.level = 0, .index = run, .cells = {}};
  for (RunRecord& record : of_run) {
    if (record.table == kRefused || !tables[record.table].folds_series)
      continue;
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

namespace {

/// Every job on the seeds of those runs; `take` gets each run's records, from
/// any thread, and `end_job` is called after the last of a job.
void RunJobs(const Study& study, const MonteCarloOptions& options, int begin,
             int end,
             const std::function<void(int, std::vector<RunRecord>)>& take,
             const std::function<void()>& end_job) {
  const double all = static_cast<double>(study.jobs.size()) * (end - begin);
  std::mutex mutex;
  int done = 0;
  for (const std::function<SeedRun()>& job : study.jobs) {
    const SeedRun run = job();
    ForEachRun(begin, end, options.threads, [&](int i) {
      take(i, run(options.first_seed + static_cast<std::uint64_t>(i)));
      const std::lock_guard lock(mutex);
      ++done;
      if (options.progress) options.progress(done / all);
    });
    end_job();
  }
}

}  // namespace

StudyResult RunStudy(const Study& study, const MonteCarloOptions& options,
                     const Watch& watch) {
  const auto table = std::make_shared<GrowingTable>(study, options.runs);
  if (watch) watch([table] { return table->SoFar(); });
  RunJobs(
      study, options, 0, options.runs,
      [&](int i, std::vector<RunRecord> records) {
        table->Set(i, std::move(records));
      },
      [&] { table->EndJob(); });
  return RequireAnswer(table->SoFar());
}

StudyShard RunShard(const Study& study, const MonteCarloOptions& options,
                    int begin, int end) {
  StudyShard shard = {begin, end, std::vector<JobRuns>(study.jobs.size())};
  std::size_t job = 0;
  std::mutex mutex;
  RunJobs(
      study, options, begin, end,
      [&](int i, std::vector<RunRecord> records) {
        const std::lock_guard lock(mutex);
        shard.jobs[job].Add(i, std::move(records), study.tables);
      },
      [&] { ++job; });
  return shard;
}

StudyResult MergeShards(const std::vector<StudyTable>& tables,
                        std::vector<StudyShard> shards) {
  std::sort(shards.begin(), shards.end(),
            [](const StudyShard& a, const StudyShard& b) {
              return a.begin < b.begin;
            });
  StudyResult result = EmptyResult(tables);
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
    Take(all, result.runs, &result);
  }
  return RequireAnswer(std::move(result));
}

}  // namespace hindsight
