#include "problems/montecarlo.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "alignment/start.h"
#include "base/error.h"

namespace hindsight {
namespace {

/// What one method made of one run.
struct MethodRun {
  bool failed = false;
  Grade grade = Grade::kUnusable;
  std::vector<Eigen::Vector3d> position;  ///< error, NED [m]
  std::vector<double> yaw;                ///< error [rad]
  std::vector<double> nees;
  double position_nees_sum = 0.0;
  double nis_sum = 0.0;
  double nis_rows = 0.0;
  double seconds = 0.0;
  std::vector<ConstantStatistics> constants;  ///< of this run alone
};

struct Run {
  std::vector<double> t;
  std::vector<MethodRun> methods;
  std::vector<Agreement> agreements;
};

constexpr double kTimeTolerance = 1e-6;

/// The nodes of a solution at which it is judged.
std::vector<std::size_t> JudgedNodes(const std::vector<double>& times,
                                     const Solution& solution) {
  std::vector<std::size_t> nodes;
  std::size_t next = 0;
  for (std::size_t k = 0; k < solution.states.size(); ++k) {
    const double t = solution.states[k].t;
    while (next < times.size() && times[next] < t - kTimeTolerance) ++next;
    if (times.empty() ||
        (next < times.size() && times[next] <= t + kTimeTolerance)) {
      nodes.push_back(k);
    }
  }
  return nodes;
}

/// The known parameters of the state, constants of simulated data.
void TakeTrueConstants(const Dataset& dataset, const ErrorLayout& layout,
                       State* y) {
  for (const Block& block : layout.blocks()) {
    if (block.parameter_offset < 0) continue;
    for (int i = 0; i < block.dim; ++i) {
      const auto constant =
          dataset.true_constants.find(layout.ComponentName(block.offset + i));
      if (constant == dataset.true_constants.end()) continue;
      y->parameters(block.parameter_offset + i) = constant->second;
    }
  }
}

/// States of a solution at those nodes.
std::vector<State> StatesAt(const Solution& solution,
                            const std::vector<std::size_t>& nodes) {
  std::vector<State> states;
  states.reserve(nodes.size());
  for (const std::size_t k : nodes) states.push_back(solution.states[k]);
  return states;
}

std::vector<ConstantStatistics> JudgeConstants(const Dataset& dataset,
                                               const Solution& solution) {
  std::vector<ConstantStatistics> out;
  for (const ConstantEstimate& c : solution.constants) {
    const auto truth = dataset.true_constants.find(c.name);
    if (truth == dataset.true_constants.end()) continue;
    ConstantStatistics s;
    s.name = c.name;
    s.unit = c.unit;
    s.prior_sigma = c.prior_sigma;
    s.sigma = c.sigma;
    s.rms = std::abs(c.value - truth->second);
    s.anees = (s.rms / s.sigma) * (s.rms / s.sigma);
    s.runs = 1;
    s.observed = c.verdict == ConstantEstimate::Verdict::kObserved ? 1 : 0;
    s.unobserved = c.verdict == ConstantEstimate::Verdict::kUnobserved ? 1 : 0;
    out.push_back(s);
  }
  return out;
}

MethodRun JudgeRun(const Solution& solution,
                   const std::vector<std::size_t>& nodes,
                   const std::vector<State>& truth) {
  MethodRun run;
  run.grade = solution.grade;
  run.seconds = solution.seconds;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const State& x = solution.states[nodes[i]];
    const ErrorVector e = Local(solution.layout, x, truth[i]);
    run.position.push_back(
        e.segment<3>(solution.layout.Find(BlockKind::kPosition)->offset));
    run.yaw.push_back(WrapAngle(truth[i].euler().z() - x.euler().z()));
    const ErrorMatrix P = solution.covariances.Get(nodes[i]);
    run.nees.push_back(e.dot(P.llt().solve(e)));
    const int p = solution.layout.Find(BlockKind::kPosition)->offset;
    const Eigen::Vector3d e_p = e.segment<3>(p);
    run.position_nees_sum += e_p.dot(P.block<3, 3>(p, p).llt().solve(e_p));
  }
  for (const ResidualRecord& record : solution.residuals) {
    if (!record.accepted || record.withheld) continue;
    run.nis_sum += record.nis;
    run.nis_rows += static_cast<double>(record.residual.size());
  }
  return run;
}

Agreement Compare(const Solution& a, const Solution& b, double first_leg_end) {
  Agreement out;
  out.first = a.method;
  out.second = b.method;
  for (std::size_t k = 0; k < a.states.size(); ++k) {
    const double position = (a.states[k].p_e - b.states[k].p_e).norm();
    out.position = std::max(out.position, position);
    out.attitude = std::max(out.attitude,
                            a.states[k].q_eb.angularDistance(b.states[k].q_eb));
    if (a.states[k].t > first_leg_end) {
      out.position_after_first_leg =
          std::max(out.position_after_first_leg, position);
    }
  }
  return out;
}

void RunCase(const MonteCarloCase& c, const MonteCarloOptions& options,
             std::uint64_t seed, Run* out) {
  const Dataset dataset = c.dataset(seed);
  ReconstructionOptions reconstruction_options;
  reconstruction_options.stop = options.stop;
  reconstruction_options.node_times = options.node_times;
  const double first_leg_end =
      options.leg_ends.empty() ? 0.0 : options.leg_ends.front();
  Reconstruction reconstruction(dataset, reconstruction_options);
  std::vector<Solution> solutions;
  std::vector<State> truth;
  for (const std::string& method : c.methods) {
    MethodRun& run = out->methods.emplace_back();
    try {
      Solution solution = reconstruction.Run(method);
      const std::vector<std::size_t> nodes =
          JudgedNodes(options.node_times, solution);
      if (truth.empty()) {
        truth = TrueStates(dataset, solution.layout, StatesAt(solution, nodes));
      }
      run = JudgeRun(solution, nodes, truth);
      run.constants = JudgeConstants(dataset, solution);
      run.failed = !solution.converged;
      solution.method += c.suffix;
      solution.covariances = {};
      solutions.push_back(std::move(solution));
    } catch (const EstimationError&) {
      run.failed = true;
    }
  }
  if (out->t.empty()) {
    for (const State& x : truth) out->t.push_back(x.t);
  }
  for (std::size_t i = 0; i < solutions.size(); ++i) {
    for (std::size_t j = i + 1; j < solutions.size(); ++j) {
      out->agreements.push_back(
          Compare(solutions[i], solutions[j], first_leg_end));
    }
  }
}

/// Standard deviation over the runs of the value that `get` takes from each.
template <typename Value, typename Get>
Value Deviation(const std::vector<const MethodRun*>& runs, const Value& zero,
                Get get) {
  const double n = static_cast<double>(runs.size());
  Value mean = zero;
  for (const MethodRun* run : runs) mean += get(*run) / n;
  Value sum = zero;
  for (const MethodRun* run : runs) {
    const Value e = get(*run) - mean;
    sum += e.cwiseProduct(e);
  }
  return (sum / std::max(1.0, n - 1.0)).cwiseSqrt();
}

/// Sums one run's constants into those of all; FinishConstants divides.
void AddConstants(const std::vector<ConstantStatistics>& of_run,
                  std::vector<ConstantStatistics>* all) {
  if (all->empty()) *all = std::vector<ConstantStatistics>(of_run.size());
  for (std::size_t i = 0; i < of_run.size(); ++i) {
    ConstantStatistics& sum = (*all)[i];
    const ConstantStatistics& one = of_run[i];
    sum.name = one.name;
    sum.unit = one.unit;
    sum.prior_sigma = one.prior_sigma;
    sum.sigma += one.sigma;
    sum.rms += one.rms * one.rms;
    sum.anees += one.anees;
    sum.runs += 1;
    sum.observed += one.observed;
    sum.unobserved += one.unobserved;
  }
}

void FinishConstants(std::vector<ConstantStatistics>* all) {
  for (ConstantStatistics& c : *all) {
    c.sigma /= c.runs;
    c.rms = std::sqrt(c.rms / c.runs);
    c.anees /= c.runs;
  }
}

void AddSeries(const std::vector<const MethodRun*>& runs, std::size_t k,
               MethodStatistics* out) {
  using Scalar = Eigen::Matrix<double, 1, 1>;
  out->std_series.push_back(
      Deviation(runs, Eigen::Vector3d(Eigen::Vector3d::Zero()),
                [k](const MethodRun& run) { return run.position[k]; }));
  out->yaw_series.push_back(
      Deviation(runs, Scalar(Scalar::Zero()),
                [k](const MethodRun& run) { return Scalar(run.yaw[k]); })(0));
  double nees = 0.0;
  for (const MethodRun* run : runs) nees += run->nees[k];
  out->anees_series.push_back(nees / static_cast<double>(runs.size()));
}

/// Maxima and means over time of the series.
void SummarizeSeries(const std::vector<double>& leg_ends,
                     std::pair<double, double> bounds, MethodStatistics* out) {
  std::vector<double> counts(std::max<std::size_t>(1, leg_ends.size()), 0.0);
  out->legs.assign(counts.size(), {Eigen::Vector3d::Zero(), 0.0});
  double outside = 0.0;
  std::size_t leg = 0;
  for (std::size_t k = 0; k < out->t.size(); ++k) {
    while (leg + 1 < leg_ends.size() && out->t[k] > leg_ends[leg]) ++leg;
    const double anees = out->anees_series[k];
    out->legs[leg].max_std =
        out->legs[leg].max_std.cwiseMax(out->std_series[k]);
    out->legs[leg].anees += anees;
    counts[leg] += 1.0;
    out->anees += anees / static_cast<double>(out->t.size());
    outside += anees < bounds.first || anees > bounds.second ? 1.0 : 0.0;
    out->yaw_std = std::max(out->yaw_std, out->yaw_series[k]);
  }
  for (std::size_t i = 0; i < counts.size(); ++i) {
    out->legs[i].anees /= std::max(1.0, counts[i]);
    out->max_std = out->max_std.cwiseMax(out->legs[i].max_std);
  }
  out->anees_outside = outside / static_cast<double>(out->t.size());
  out->final_std = out->std_series.back();
}

void SummarizeErrors(const std::vector<const MethodRun*>& runs,
                     MethodStatistics* out) {
  const double n = static_cast<double>(runs.size() * out->t.size());
  double position = 0.0;
  double heading = 0.0;
  double final_horizontal = 0.0;
  for (const MethodRun* run : runs) {
    for (const Eigen::Vector3d& e : run->position) position += e.squaredNorm();
    for (const double yaw : run->yaw) heading += yaw * yaw;
    final_horizontal += run->position.back().head<2>().squaredNorm();
    out->position_nees += run->position_nees_sum / n;
  }
  out->position_rms = std::sqrt(position / n);
  out->heading_rms = std::sqrt(heading / n);
  out->final_horizontal =
      std::sqrt(final_horizontal / static_cast<double>(runs.size()));
}

MethodStatistics Summarize(const std::string& name, std::size_t index,
                           std::span<const Run> runs, int dim,
                           const MonteCarloOptions& options) {
  MethodStatistics out;
  out.name = name;
  out.max_std.setZero();
  out.final_std.setZero();
  std::vector<const MethodRun*> finished;
  double nis_sum = 0.0;
  double nis_rows = 0.0;
  for (const Run& run : runs) {
    const MethodRun& method = run.methods[index];
    ++out.grades[static_cast<std::size_t>(method.grade)];
    if (method.failed) {
      ++out.failed;
      continue;
    }
    finished.push_back(&method);
    nis_sum += method.nis_sum;
    nis_rows += method.nis_rows;
    out.seconds += method.seconds;
    AddConstants(method.constants, &out.constants);
    if (out.t.empty()) out.t = run.t;
  }
  if (finished.empty()) return out;
  out.seconds /= static_cast<double>(finished.size());
  out.nis = nis_sum / nis_rows;
  FinishConstants(&out.constants);
  for (std::size_t k = 0; k < out.t.size(); ++k) AddSeries(finished, k, &out);
  SummarizeErrors(finished, &out);
  SummarizeSeries(options.leg_ends,
                  options.anees_bounds(static_cast<int>(finished.size()), dim),
                  &out);
  return out;
}

void Widen(const Agreement& one, std::vector<Agreement>* all) {
  for (Agreement& a : *all) {
    if (a.first != one.first || a.second != one.second) continue;
    a.position = std::max(a.position, one.position);
    a.attitude = std::max(a.attitude, one.attitude);
    a.position_after_first_leg =
        std::max(a.position_after_first_leg, one.position_after_first_leg);
    return;
  }
  all->push_back(one);
}

MonteCarloResult ResultOf(const std::vector<MonteCarloCase>& cases,
                          const MonteCarloOptions& options, int dim,
                          std::span<const Run> runs) {
  MonteCarloResult result;
  result.runs = static_cast<int>(runs.size());
  result.dim = dim;
  std::size_t index = 0;
  for (const MonteCarloCase& c : cases) {
    for (const std::string& method : c.methods) {
      result.methods.push_back(
          Summarize(method + c.suffix, index++, runs, result.dim, options));
    }
  }
  for (const Run& run : runs) {
    for (const Agreement& a : run.agreements) Widen(a, &result.agreements);
  }
  return result;
}

}  // namespace

std::vector<State> TrueStates(const Dataset& dataset, const ErrorLayout& layout,
                              const std::vector<State>& states) {
  std::vector<State> truth;
  truth.reserve(states.size());
  std::size_t i = 0;
  for (const State& x : states) {
    while (i < dataset.truth.size() &&
           dataset.truth[i].t < x.t - kTimeTolerance) {
      ++i;
    }
    if (i == dataset.truth.size() ||
        dataset.truth[i].t > x.t + kTimeTolerance) {
      throw InputError("data set '" + dataset.name + "' has no truth at " +
                       std::to_string(x.t) + " s, where a node stands");
    }
    const TruthPoint point = dataset.truth[i];
    State& y = truth.emplace_back(x);
    y.p_e = point.p_e.value();
    const Eigen::Matrix3d C_en = NedAxes(y.p_e);
    y.v_e = C_en * point.v_n.value();
    y.q_eb = Eigen::Quaterniond(C_en) * point.q_nb.value();
    y.b_g = point.b_g.value();
    y.b_a = point.b_a.value();
    TakeTrueConstants(dataset, layout, &y);
  }
  return truth;
}

void ForEachSeed(
    const MonteCarloOptions& options,
    const std::function<void(std::size_t i, std::uint64_t seed)>& work) {
  const auto count = static_cast<std::size_t>(options.runs);
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  int done = 0;
  std::exception_ptr thrown;
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i, options.first_seed + i);
        const std::lock_guard lock(mutex);
        ++done;
        if (options.progress) options.progress(done);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!thrown) thrown = std::current_exception();
        next = count;
      }
    }
  };
  std::vector<std::thread> threads;
  for (int i = 1; i < options.threads; ++i) threads.emplace_back(run);
  run();
  for (std::thread& thread : threads) thread.join();
  if (thrown) std::rethrow_exception(thrown);
}

MonteCarloResult RunMonteCarlo(const std::vector<MonteCarloCase>& cases,
                               const MonteCarloOptions& options,
                               const Watch<MonteCarloResult>& watch) {
  const auto runs = std::make_shared<FinishedRuns<Run>>(options.runs);
  const Dataset first = cases.front().dataset(options.first_seed);
  const int dim = BuildLayout(first, NavigationPrior{}).dim();
  const auto so_far = [runs, cases, options, dim] {
    return runs->OfFirst([&](std::span<const Run> finished) {
      return ResultOf(cases, options, dim, finished);
    });
  };
  if (watch) watch(so_far);
  ForEachSeed(options, [&](std::size_t i, std::uint64_t seed) {
    Run run;
    for (const MonteCarloCase& c : cases) RunCase(c, options, seed, &run);
    runs->Set(i, std::move(run));
  });
  return so_far();
}

}  // namespace hindsight
