#ifndef HINDSIGHT_PROBLEMS_MONTECARLO_H_
#define HINDSIGHT_PROBLEMS_MONTECARLO_H_

#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "dataset/dataset.h"
#include "problems/study_result.h"

namespace hindsight {

/// A recording of a seed, with truth; the same for the same seed.
using Recording = std::function<Dataset(std::uint64_t seed)>;

/// Gathers what is made of one case's recording of one seed.
struct CaseRun {
  std::vector<std::string> labels;  ///< of the case
  std::uint64_t seed = 0;
  std::deque<RunRecord> records = {};

  /// Lets `work` fill a record of table 0. An EstimationError or InputError
  /// that it throws makes the run a failed one without an answer.
  void Try(const std::vector<std::string>& method,
           const std::function<void(RunRecord*)>& work);
  /// A record of the table with these labels after those of the case.
  RunRecord* Add(std::size_t table, const std::vector<std::string>& own_labels);
};

/// What methods make of a recording.
struct Trial {
  /// Labels of each method, behind those of the case, in table 0.
  std::vector<std::vector<std::string>> methods;
  /// A record each, in the same order for every seed. Called from several
  /// threads at once.
  std::function<void(const Dataset& dataset, CaseRun* run)> run;
};
/// Labels of methods that have a name each.
std::vector<std::vector<std::string>> Named(
    const std::vector<std::string>& methods);

/// Recordings of one kind and what is tried on them. A recording that cannot be
/// made, or that the trial refuses with an InputError, is a failed run of every
/// method.
struct Case {
  std::vector<std::string> labels;
  /// Called once, when its turn comes; empty: the trial needs no recording.
  std::function<Recording()> prepare;
  Trial trial;
};

/// A Monte Carlo comparison: cases x methods x seeds to one long table.
struct Study {
  std::string name = {};
  /// What was chosen besides the cases, for the reports: key and value.
  std::vector<std::pair<std::string, std::string>> settings = {};
  std::vector<StudyTable> tables = {};  ///< of RunRecord::table
  /// One after the other, each prepared when its turn comes and dropped when all
  /// its seeds are done.
  std::vector<Case> cases = {};
};

struct MonteCarloOptions {
  int runs = 100;
  std::uint64_t first_seed = 1;  ///< run i has seed first_seed + i
  int threads = 1;
  /// Called with the share of all runs done, in (0, 1], one call at a time.
  std::function<void(double)> progress = {};
};

/// A study's work on some of its runs, by the threads that do it.
class StudyRun {
 public:
  /// Of the runs begin to end - 1.
  StudyRun(Study study, MonteCarloOptions options, int begin, int end);

  /// Runs every case on the seeds of those runs. The result is the same to the
  /// last bit whatever the number of threads, seconds excepted. Throws what the
  /// cases throw, the first exception stopping the rest.
  void Do();

  /// What is finished at this time, of runs from 0 on; may be called by any
  /// thread, before, within and after Do.
  StudyResult SoFar() const;
  /// All of it, after Do.
  const StudyShard& shard() const { return shard_; }

 private:
  void Take(int run, std::vector<RunRecord> records);

  Study study_;
  MonteCarloOptions options_;
  mutable std::mutex mutex_;
  StudyShard shard_;
  std::size_t finished_ = 0;  ///< cases
  int done_ = 0;              ///< runs of all cases
};

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_MONTECARLO_H_
