#include "problems/jump_comparison.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "base/error.h"
#include "base/processor_time.h"
#include "dataset/timeline_builder.h"
#include "filters/imm_smoother.h"
#include "problems/position_imm.h"

namespace hindsight {
namespace {

/// Sums over runs, by node.
struct Sums {
  std::string name;
  int runs = 0;
  int failed = 0;
  double seconds = 0.0;
  std::vector<double> t;
  std::vector<Eigen::Vector2d> position;
  std::vector<Eigen::Vector2d> velocity;
  std::vector<double> nees;
  std::vector<Eigen::VectorXd> probabilities;
};

TruthPoint TruthAt(const Dataset& dataset, double t, std::size_t* hint) {
  constexpr double kTimeTolerance = 1e-6;
  std::size_t& i = *hint;
  while (i < dataset.truth.size() && dataset.truth[i].t < t - kTimeTolerance) {
    ++i;
  }
  if (i == dataset.truth.size() || dataset.truth[i].t > t + kTimeTolerance) {
    throw InputError("data set '" + dataset.name + "' has no truth at " +
                     std::to_string(t) + " s, where a node stands");
  }
  return dataset.truth[i];
}

/// One run of one method; `P` is over a layout whose first two components are
/// the position north and east.
Sums JudgeJumps(const Dataset& dataset, const std::vector<State>& states,
                const CovarianceSeries& P,
                const std::vector<Eigen::VectorXd>& probabilities) {
  Sums out;
  out.runs = 1;
  out.probabilities = probabilities;
  std::size_t hint = 0;
  for (std::size_t k = 0; k < states.size(); ++k) {
    const State& x = states[k];
    const TruthPoint truth = TruthAt(dataset, x.t, &hint);
    const Eigen::Vector2d e =
        (x.C_en().transpose() * (truth.p_e.value() - x.p_e)).head<2>();
    const Eigen::Vector2d v = (truth.v_n.value() - x.v_n()).head<2>();
    const Eigen::Matrix2d P_h = P.Get(k).topLeftCorner<2, 2>();
    out.t.push_back(x.t);
    out.position.emplace_back(e.cwiseAbs2());
    out.velocity.emplace_back(v.cwiseAbs2());
    out.nees.push_back(e.dot(P_h.llt().solve(e)));
  }
  return out;
}

template <typename T>
void Accumulate(const std::vector<T>& one, std::vector<T>* all) {
  if (all->empty()) {
    *all = one;
    return;
  }
  for (std::size_t k = 0; k < one.size(); ++k) (*all)[k] += one[k];
}

void Add(const Sums& one, Sums* all) {
  all->name = one.name;
  all->runs += one.runs;
  all->failed += one.failed;
  all->seconds += one.seconds;
  if (one.t.empty()) return;
  all->t = one.t;
  Accumulate(one.position, &all->position);
  Accumulate(one.velocity, &all->velocity);
  Accumulate(one.nees, &all->nees);
  Accumulate(one.probabilities, &all->probabilities);
}

/// The methods of one seed, one after the other.
class OneRun {
 public:
  OneRun(const Dataset& dataset, const MonteCarloOptions& options)
      : dataset_(dataset), options_(options) {}

  std::vector<Sums> Run() {
    RunPaper();
    RunReconstruction();
    return std::move(out_);
  }

 private:
  void RunPaper() {
    constexpr double kForever = std::numeric_limits<double>::infinity();
    Start start = FindStart(dataset_, -kForever, kForever);
    TimelineOptions timeline_options;
    timeline_options.t_begin = start.report.t;
    timeline_options.t_end = dataset_.imu.t_end();
    timeline_options.with_scale_jacobians = true;
    Timeline timeline = BuildTimeline(dataset_, timeline_options);
    start.prior.x.t = timeline.node(0).t;
    const PositionImmOptions both;
    for (std::size_t i = 0; i < both.amplitudes.size(); ++i) {
      PositionImmOptions single = both;
      single.amplitudes = {both.amplitudes[i]};
      const double t0 = ProcessorSeconds();
      const ImmResult result =
          RunPositionImm(dataset_, start, single, &timeline);
      Keep("kf" + std::to_string(i), result.trajectory,
           ProcessorSeconds() - t0);
    }
    double t0 = ProcessorSeconds();
    const ImmResult result = RunPositionImm(dataset_, start, both, &timeline);
    Keep("imm", result.trajectory, ProcessorSeconds() - t0);
    t0 = ProcessorSeconds();
    const ImmSmoothed smoothed = SmoothImm(result.tape);
    Keep("imm_smoother", smoothed.trajectory, ProcessorSeconds() - t0);
  }

  void Keep(const std::string& name, const ImmTrajectory& trajectory,
            double seconds) {
    Sums sums = JudgeJumps(dataset_, trajectory.states, trajectory.P,
                           trajectory.probabilities);
    sums.name = name;
    sums.seconds = seconds;
    out_.push_back(std::move(sums));
  }

  void RunReconstruction() {
    ReconstructionOptions reconstruction_options;
    reconstruction_options.stop = options_.stop;
    Reconstruction reconstruction(dataset_, reconstruction_options);
    for (const std::string method :
         {"gated_ekf", "rts", "batch", "robust_batch"}) {
      Sums sums;
      try {
        const Solution solution = reconstruction.Run(method);
        if (solution.converged) {
          // Modes may differ from seed to seed: no mean of them.
          sums =
              JudgeJumps(dataset_, solution.states, solution.covariances, {});
          sums.seconds = solution.seconds;
        }
      } catch (const EstimationError&) {
        // Counted as failed below.
      }
      if (sums.runs == 0) sums.failed = 1;
      sums.name = method;
      out_.push_back(std::move(sums));
    }
  }

  const Dataset& dataset_;
  const MonteCarloOptions& options_;
  std::vector<Sums> out_;
};

std::vector<std::vector<Sums>> RunAll(
    const std::function<Dataset(std::uint64_t)>& dataset,
    const MonteCarloOptions& options) {
  std::vector<std::vector<Sums>> runs(static_cast<std::size_t>(options.runs));
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  int done = 0;
  std::exception_ptr thrown;
  const auto work = [&] {
    for (std::size_t i = next++; i < runs.size(); i = next++) {
      try {
        const Dataset one = dataset(options.first_seed + i);
        runs[i] = OneRun(one, options).Run();
        const std::lock_guard lock(mutex);
        ++done;
        if (options.progress) options.progress(done);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!thrown) thrown = std::current_exception();
        next = runs.size();
      }
    }
  };
  std::vector<std::thread> threads;
  for (int i = 1; i < options.threads; ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  if (thrown) std::rethrow_exception(thrown);
  return runs;
}

JumpStatistics Finish(const Sums& sums) {
  JumpStatistics out;
  out.name = sums.name;
  out.failed = sums.failed;
  if (sums.runs == 0) return out;
  const double n = sums.runs;
  out.seconds = sums.seconds / n;
  out.t = sums.t;
  for (std::size_t k = 0; k < sums.t.size(); ++k) {
    out.position_rms.emplace_back((sums.position[k] / n).cwiseSqrt());
    out.velocity_rms.emplace_back((sums.velocity[k] / n).cwiseSqrt());
    out.anees.push_back(sums.nees[k] / n);
    if (!sums.probabilities.empty()) {
      out.probabilities.emplace_back(sums.probabilities[k] / n);
    }
  }
  return out;
}

double RmsOver(const std::vector<double>& t,
               const std::vector<Eigen::Vector2d>& rms, double from,
               double to) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t k = 0; k < t.size(); ++k) {
    if (t[k] < from || t[k] > to) continue;
    sum += 0.5 * rms[k].squaredNorm();
    ++count;
  }
  return std::sqrt(sum / std::max(1, count));
}

}  // namespace

double JumpStatistics::PositionRms(double from, double to) const {
  return RmsOver(t, position_rms, from, to);
}

double JumpStatistics::VelocityRms(double from, double to) const {
  return RmsOver(t, velocity_rms, from, to);
}

double JumpStatistics::Anees(double from, double to) const {
  double sum = 0.0;
  int count = 0;
  for (std::size_t k = 0; k < t.size(); ++k) {
    if (t[k] < from || t[k] > to) continue;
    sum += anees[k];
    ++count;
  }
  return sum / std::max(1, count);
}

std::vector<JumpStatistics> CompareOnJumps(
    const std::function<Dataset(std::uint64_t seed)>& dataset,
    const MonteCarloOptions& options) {
  const std::vector<std::vector<Sums>> runs = RunAll(dataset, options);
  std::vector<JumpStatistics> out;
  for (std::size_t m = 0; m < runs.front().size(); ++m) {
    Sums all;
    for (const std::vector<Sums>& run : runs) Add(run[m], &all);
    out.push_back(Finish(all));
  }
  return out;
}

}  // namespace hindsight
