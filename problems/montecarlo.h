#ifndef HINDSIGHT_PROBLEMS_MONTECARLO_H_
#define HINDSIGHT_PROBLEMS_MONTECARLO_H_

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "problems/reconstruction.h"

namespace hindsight {

/// Recordings that differ in the seed of their errors alone, with truth at
/// every node, and the methods to try on them.
struct MonteCarloCase {
  std::string suffix;  ///< of the methods' names in the results
  std::function<Dataset(std::uint64_t seed)> dataset;
  std::vector<std::string> methods;
};

struct MonteCarloOptions {
  int runs = 100;
  std::uint64_t first_seed = 1;  ///< run i has seed first_seed + i
  int threads = 1;
  /// Ends of the legs into which the interval is divided [s], ascending.
  std::vector<double> leg_ends;
  /// Nodes are also placed at these times, and the states judged at them alone
  /// [s]; empty: at every node, each of which then needs truth.
  std::vector<double> node_times;
  /// ANEES bounds for `outside` of so many runs and states, two-sided.
  std::function<std::pair<double, double>(int runs, int dim)> anees_bounds;
  /// Called with the number of runs done, from any thread, one at a time.
  std::function<void(int)> progress;
  const std::atomic<bool>* stop = nullptr;  ///< Interrupted when it is set
};

/// An estimated constant over all runs whose data set knows its true value.
struct ConstantStatistics {
  std::string name;
  std::string unit;
  double prior_sigma = 0.0;
  double sigma = 0.0;  ///< as estimated, mean over the runs
  double rms = 0.0;    ///< of the error
  /// Mean of (error / sigma)^2; right is 1.
  double anees = 0.0;
  int runs = 0;
  int observed = 0;    ///< runs with that verdict
  int unobserved = 0;  ///< likewise; the others are weak
};

/// One method over all runs that it finished. Standard deviations are over the
/// runs, about their mean; maxima are over time.
struct MethodStatistics {
  std::string name;
  int failed = 0;  ///< runs without an answer or convergence, left out
  /// Runs graded usable, doubtful, not usable; the failed are among the last.
  std::array<int, 3> grades = {};
  Eigen::Vector3d max_std;  ///< of the position error, NED [m]
  struct Leg {
    Eigen::Vector3d max_std;  ///< NED [m]
    double anees = 0.0;       ///< mean over the leg
  };
  std::vector<Leg> legs;
  Eigen::Vector3d final_std;  ///< at the last node, NED [m]
  double yaw_std = 0.0;       ///< largest over time [rad]
  /// Mean over time of the average over runs of e' P^-1 e, e the whole error
  /// state; right is its dimension.
  double anees = 0.0;
  double anees_outside = 0.0;  ///< share of epochs outside the bounds
  /// Mean over time and runs of e' P^-1 e, e the position error; right is 3.
  double position_nees = 0.0;
  double nis = 0.0;  ///< per row of the residuals, mean; right is 1
  /// Root mean squares over time and runs.
  double position_rms = 0.0;  ///< of the 3-D error [m]
  double heading_rms = 0.0;   ///< [rad]
  /// Root mean square over the runs of the horizontal error at the last node
  /// [m].
  double final_horizontal = 0.0;
  double seconds = 0.0;  ///< processor time of the method alone, mean
  std::vector<ConstantStatistics> constants;
  std::vector<double> t;  ///< of the series that follow
  std::vector<Eigen::Vector3d> std_series;
  std::vector<double> yaw_series;
  std::vector<double> anees_series;
};

/// Largest distance of two methods over all nodes and runs.
struct Agreement {
  std::string first, second;              ///< names of the methods
  double position = 0.0;                  ///< [m]
  double attitude = 0.0;                  ///< [rad]
  double position_after_first_leg = 0.0;  ///< [m]
};

struct MonteCarloResult {
  int runs = 0;  ///< behind the figures, the first ones
  int dim = 0;   ///< of the error state
  std::vector<MethodStatistics> methods;
  std::vector<Agreement> agreements;  ///< of all pairs within a case
};

/// What every run gave, set by the threads that do the work and read by others
/// meanwhile.
template <typename Run>
class FinishedRuns {
 public:
  explicit FinishedRuns(int runs)
      : runs_(static_cast<std::size_t>(runs)), is_finished_(runs_.size()) {}

  void Set(std::size_t i, Run run) {
    const std::lock_guard lock(mutex_);
    runs_[i] = std::move(run);
    is_finished_[i] = true;
  }

  /// summarize(span of the first runs, as many as are finished without a gap):
  /// what a comparison of that many runs gives.
  template <typename Summarize>
  auto OfFirst(const Summarize& summarize) const {
    const std::lock_guard lock(mutex_);
    const auto gap = std::find(is_finished_.begin(), is_finished_.end(), false);
    const auto count = static_cast<std::size_t>(gap - is_finished_.begin());
    return summarize(std::span<const Run>(runs_.data(), count));
  }

 private:
  mutable std::mutex mutex_;
  std::vector<Run> runs_;
  std::vector<bool> is_finished_;
};

/// Gets, before the first run, a function that gives at any time and to any
/// thread the result of the runs that are finished then (FinishedRuns).
template <typename Result>
using Watch = std::function<void(std::function<Result()> so_far)>;

/// Calls work(i, first_seed + i) for every run on so many threads and reports
/// progress. The first exception stops the rest and is thrown.
void ForEachSeed(
    const MonteCarloOptions& options,
    const std::function<void(std::size_t i, std::uint64_t seed)>& work);

/// True states at the times of `states`, in a layout's parameters too where
/// the data set knows them. Throws InputError where there is no truth.
std::vector<State> TrueStates(const Dataset& dataset, const ErrorLayout& layout,
                              const std::vector<State>& states);

/// Runs every method on every seed. The result is the same to the last bit
/// whatever the number of threads, seconds excepted. Throws InputError if a
/// node has no truth, and what Reconstruction throws but EstimationError, which
/// counts as failed.
MonteCarloResult RunMonteCarlo(const std::vector<MonteCarloCase>& cases,
                               const MonteCarloOptions& options,
                               const Watch<MonteCarloResult>& watch = {});

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_MONTECARLO_H_
