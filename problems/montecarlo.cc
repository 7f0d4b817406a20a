#include "problems/montecarlo.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <iterator>
#include <mutex>
#include <thread>

#include "base/error.h"

namespace hindsight {
namespace {

/// The recordings of a case; if it cannot be prepared each is refused.
Recording Prepare(const Case& one) {
  if (!one.prepare) return [](std::uint64_t) { return Dataset(); };
  try {
    return one.prepare();
  } catch (const InputError& error) {
    return [error](std::uint64_t) -> Dataset { throw error; };
  }
}

std::vector<RunRecord> RunCase(const Case& one, const Recording& recording,
                               std::uint64_t seed) {
  CaseRun run = {one.labels, seed};
  try {
    one.trial.run(recording(seed), &run);
  } catch (const InputError& error) {
    run.records.clear();
    for (const std::vector<std::string>& method : one.trial.methods) {
      run.Add(0, method)->Fail(error.what());
    }
  }
  return {std::make_move_iterator(run.records.begin()),
          std::make_move_iterator(run.records.end())};
}

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

std::vector<std::vector<std::string>> Named(
    const std::vector<std::string>& methods) {
  std::vector<std::vector<std::string>> labels;
  for (const std::string& method : methods) labels.push_back({method});
  return labels;
}

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

StudyRun::StudyRun(Study study, MonteCarloOptions options, int begin, int end)
    : study_(std::move(study)),
      options_(std::move(options)),
      shard_{begin, end, std::vector<CaseRuns>(study_.cases.size())} {}

void StudyRun::Do() {
  for (const Case& one : study_.cases) {
    const Recording recording = Prepare(one);
    ForEachRun(shard_.begin, shard_.end, options_.threads, [&](int i) {
      const auto number = static_cast<std::uint64_t>(i);
      Take(i, RunCase(one, recording, options_.first_seed + number));
    });
    const std::lock_guard lock(mutex_);
    ++finished_;
  }
}

StudyResult StudyRun::SoFar() const {
  const std::lock_guard lock(mutex_);
  return {study_.tables, shard_, finished_};
}

void StudyRun::Take(int run, std::vector<RunRecord> records) {
  const std::lock_guard lock(mutex_);
  shard_.cases[finished_].Add(run, std::move(records));
  ++done_;
  const double all =
      static_cast<double>(study_.cases.size()) * (shard_.end - shard_.begin);
  if (options_.progress) options_.progress(done_ / all);
}

}  // namespace hindsight
