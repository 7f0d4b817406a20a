#include "problems/montecarlo.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <iterator>
#include <memory>
#include <mutex>
#include <thread>

#include "base/error.h"

namespace hindsight {
namespace {

/// The recordings of each case; of one that cannot be prepared each is refused.
std::vector<Recording> Prepare(const std::vector<Case>& cases) {
  std::vector<Recording> recordings;
  for (const Case& one : cases) {
    try {
      recordings.push_back(one.prepare ? one.prepare() : [](std::uint64_t) {
        return Dataset();
      });
    } catch (const InputError& error) {
      recordings.emplace_back(
          [error](std::uint64_t) -> Dataset { throw error; });
    }
  }
  return recordings;
}

/// Of all cases on one seed.
std::vector<RunRecord> RunCases(const std::vector<Case>& cases,
                                const std::vector<Recording>& recordings,
                                std::uint64_t seed) {
  std::vector<RunRecord> out;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    CaseRun run = {cases[i].labels, seed};
    try {
      cases[i].trial(recordings[i](seed), &run);
    } catch (const InputError& error) {
      run.records.clear();
      run.Add(kRefused, {})->Fail(error.what());
    }
    std::ranges::move(run.records, std::back_inserter(out));
  }
  return out;
}

/// The table as it grows, set by the threads that do the work and read by
/// others meanwhile.
class GrowingTable {
 public:
  GrowingTable(Study study, int runs)
      : study_(std::move(study)), runs_(runs), jobs_so_far_(study_.tables) {}

  void Set(int run, std::vector<RunRecord> records) {
    const std::lock_guard lock(mutex_);
    of_job_.Add(run, std::move(records), study_.tables);
  }

  /// All seeds of the job are in: their figures stay, their series go.
  void EndJob() {
    const std::lock_guard lock(mutex_);
    jobs_so_far_.Add(of_job_, runs_);
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
      result.Add(of_job_, result.runs);
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

/// Every job on the seeds of those runs; `take` gets each run's records, from
/// any thread, and `end_job` is called after the last of a job.
void RunJobs(const Study& study, const MonteCarloOptions& options, int begin,
             int end,
             const std::function<void(int, std::vector<RunRecord>)>& take,
             const std::function<void()>& end_job) {
  const double all = static_cast<double>(study.jobs.size()) * (end - begin);
  std::mutex mutex;
  int done = 0;
  for (const std::vector<Case>& job : study.jobs) {
    const std::vector<Recording> recordings = Prepare(job);
    ForEachRun(begin, end, options.threads, [&](int i) {
      take(i, RunCases(job, recordings,
                       options.first_seed + static_cast<std::uint64_t>(i)));
      const std::lock_guard lock(mutex);
      ++done;
      if (options.progress) options.progress(done / all);
    });
    end_job();
  }
}

}  // namespace

void CaseRun::Try(const std::vector<std::string>& method,
                  const std::function<void(RunRecord*)>& work) {
  RunRecord* record = Add(0, method);
  try {
    work(record);
  } catch (const EstimationError&) {
    record->Fail();
  } catch (const InputError& error) {
    record->Fail(error.what());
  }
}

RunRecord* CaseRun::Add(std::size_t table,
                        const std::vector<std::string>& own_labels) {
  RunRecord& record = records.emplace_back();
  record.table = table;
  record.labels = labels;
  record.labels.insert(record.labels.end(), own_labels.begin(),
                       own_labels.end());
  record.seed = seed;
  return &record;
}

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
  StudyResult result = table->SoFar();
  result.RequireAnswer();
  return result;
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

}  // namespace hindsight
