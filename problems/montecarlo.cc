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

/// The table as it grows, set by the threads that do the work and read by
/// others meanwhile.
class GrowingTable {
 public:
  GrowingTable(Study study, int runs) : study_(std::move(study)), runs_(runs) {
    jobs_so_far_.tables = study_.tables;
    jobs_so_far_.rows.resize(study_.tables.size());
    BeginJob();
  }

  void Set(std::size_t i, std::vector<RunRecord> records) {
    const std::lock_guard lock(mutex_);
    of_job_[i] = std::move(records);
    is_finished_[i] = true;
  }

  /// All seeds of the job are in: their figures stay, their series go.
  void EndJob() {
    const std::lock_guard lock(mutex_);
    Take(Finished(), &jobs_so_far_);
    ++jobs_;
    BeginJob();
  }

  StudyResult SoFar() const {
    const std::lock_guard lock(mutex_);
    StudyResult result = jobs_so_far_;
    result.complete = jobs_ == study_.jobs.size();
    result.runs = jobs_ > 0 ? runs_ : 0;
    if (study_.jobs.size() == 1 && !result.complete) {
      const auto gap = std::find(is_finished_.begin(), is_finished_.end(), 0);
      result.runs = static_cast<int>(gap - is_finished_.begin());
      Take(Finished(), &result);
    }
    return result;
  }

 private:
  void BeginJob() {
    of_job_.assign(static_cast<std::size_t>(runs_), {});
    is_finished_.assign(static_cast<std::size_t>(runs_), 0);
  }

  /// Of the first seeds of the job, as many as are finished without a gap.
  std::vector<RunRecord> Finished() const {
    std::vector<RunRecord> all;
    for (std::size_t i = 0; i < of_job_.size() && is_finished_[i]; ++i) {
      all.insert(all.end(), of_job_[i].begin(), of_job_[i].end());
    }
    return all;
  }

  void Take(std::vector<RunRecord> job, StudyResult* to) const {
    for (const RunRecord& record : job) {
      if (!record.refusal.empty()) to->refusals.push_back(RefusalOf(record));
    }
    SpreadRefusals(study_.tables[0].labels.size(), &job);
    for (std::size_t i = 0; i < study_.tables.size(); ++i) {
      std::vector<FigureRow> of_job = Summarize(study_.tables[i], i, job);
      std::move(of_job.begin(), of_job.end(), std::back_inserter(to->rows[i]));
    }
    for (RunRecord& record : job) {
      record.t.clear();
      record.series.clear();
      to->records.push_back(std::move(record));
    }
  }

  Study study_;
  int runs_;
  mutable std::mutex mutex_;
  std::vector<std::vector<RunRecord>> of_job_;
  std::vector<char> is_finished_;
  std::size_t jobs_ = 0;
  StudyResult jobs_so_far_;  ///< of those that are done
};

/// Calls work(i) for every run on so many threads. The first exception stops
/// the rest and is thrown.
void ForEachRun(int runs, int thread_count,
                const std::function<void(std::size_t i)>& work) {
  const auto count = static_cast<std::size_t>(runs);
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr thrown;
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!thrown) thrown = std::current_exception();
        next = count;
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

StudyResult RunStudy(const Study& study, const MonteCarloOptions& options,
                     const Watch& watch) {
  const auto table = std::make_shared<GrowingTable>(study, options.runs);
  if (watch) watch([table] { return table->SoFar(); });
  const double all = static_cast<double>(study.jobs.size()) * options.runs;
  std::mutex mutex;
  int done = 0;
  for (const std::function<SeedRun()>& job : study.jobs) {
    const SeedRun run = job();
    ForEachRun(options.runs, options.threads, [&](std::size_t i) {
      table->Set(i, run(options.first_seed + i));
      const std::lock_guard lock(mutex);
      ++done;
      if (options.progress) options.progress(done / all);
    });
    table->EndJob();
  }
  StudyResult result = table->SoFar();
  if (!result.answered() && !result.refusals.empty()) {
    throw InputError(result.refusals.front());
  }
  return result;
}

}  // namespace hindsight
