#ifndef HINDSIGHT_PROBLEMS_MONTECARLO_H_
#define HINDSIGHT_PROBLEMS_MONTECARLO_H_

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "dataset/dataset.h"
#include "problems/study_result.h"

namespace hindsight {

/// A recording of a seed, with truth; the same for the same seed.
using Recording = std::function<Dataset(std::uint64_t seed)>;

/// What cases and methods make of one seed, called from several threads at
/// once: a record for each case and method, in the same order for every seed.
using SeedRun = std::function<std::vector<RunRecord>(std::uint64_t seed)>;

/// Gathers what is made of one case's recording of one seed.
class CaseRun {
 public:
  CaseRun(std::vector<std::string> labels, std::uint64_t seed,
          std::vector<RunRecord>* out)
      : labels_(std::move(labels)), seed_(seed), out_(*out) {}

  const std::vector<std::string>& labels() const { return labels_; }
  std::uint64_t seed() const { return seed_; }
  void Add(RunRecord record) { out_.push_back(std::move(record)); }

  /// Lets `work` fill a record of table 0. An EstimationError or InputError
  /// that it throws makes the run a failed one without an answer.
  void Try(const std::vector<std::string>& method,
           const std::function<void(RunRecord*)>& work);
  /// A record of the table with these labels after those of the case. The
  /// pointer holds until the next.
  RunRecord* Add(std::size_t table, const std::vector<std::string>& labels);

 private:
  RunRecord Empty(std::size_t table,
                  const std::vector<std::string>& labels) const;

  std::vector<std::string> labels_;
  std::uint64_t seed_;
  std::vector<RunRecord>& out_;
};

/// What methods make of a recording; called from several threads at once.
using Trial = std::function<void(const Dataset& dataset, CaseRun* run)>;

/// Recordings of one kind and what is tried on them.
struct Case {
  std::vector<std::string> labels;
  std::function<Recording()> prepare;  ///< called once, when its turn comes
  Trial trial;
};

/// Cases on common seeds. A recording that cannot be made, or that the trial
/// refuses with an InputError, counts as a failed run of every method.
std::function<SeedRun()> JobOf(const std::vector<Case>& cases);

/// Cases that share what is made of a seed are one job; jobs are run one after
/// the other, each made (which may simulate a motion) when its turn comes and
/// dropped when all its seeds are done.
using Jobs = std::vector<std::function<SeedRun()>>;

/// A Monte Carlo comparison: cases x methods x seeds to one long table.
struct Study {
  std::string name = {};
  /// What was chosen besides the cases, for the reports: key and value.
  std::vector<std::pair<std::string, std::string>> settings = {};
  std::vector<StudyTable> tables;  ///< of RunRecord::table
  Jobs jobs = {};
};

struct MonteCarloOptions {
  int runs = 100;
  std::uint64_t first_seed = 1;  ///< run i has seed first_seed + i
  int threads = 1;
  /// Called with the share of all runs done, in (0, 1], one call at a time.
  std::function<void(double)> progress = {};
};

/// Gets, before the first run, a function that gives at any time and to any
/// thread the result as far as it is finished then.
using Watch = std::function<void(std::function<StudyResult()> so_far)>;

/// Runs every job on every seed. The result is the same to the last bit
/// whatever the number of threads, seconds excepted. Throws what the jobs
/// throw, the first exception stopping the rest, and InputError with the first
/// refusal where data were refused and no run was answered.
StudyResult RunStudy(const Study& study, const MonteCarloOptions& options,
                     const Watch& watch = {});

/// Runs every job on the seeds of those runs alone. Throws what the jobs throw.
StudyShard RunShard(const Study& study, const MonteCarloOptions& options,
                    int begin, int end);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_MONTECARLO_H_
