#include "problems/observer_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "alignment/given.h"
#include "base/error.h"
#include "dataset/timeline_builder.h"

namespace hindsight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Prior AlignmentPrior(const Dataset& dataset, const ErrorLayout& layout) {
  const InitialState& initial = dataset.initial;
  Prior prior;
  prior.x = MakeState(dataset.imu.t_begin(), initial.position.value(),
                      initial.v_n.value(), initial.euler.value());
  prior.x.b_g = initial.gyro_bias;
  prior.x.b_a = initial.accel_bias;
  prior.x.parameters = ParameterVector::Zero(0);
  prior.P = layout.InitialCovariance();
  const int attitude = layout.Find(BlockKind::kAttitude)->offset;
  prior.P.block<3, 3>(attitude, attitude) =
      AttitudeCovariance(*initial.euler, initial.attitude_sigma.value());
  return prior;
}

/// Value below which `fraction` of the values lie, by nearest rank, so that
/// infinite ones stay infinite.
double Rank(std::vector<double> values, double fraction) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(
      std::ceil(fraction * static_cast<double>(values.size())));
  return values[std::max<std::size_t>(rank, 1) - 1];
}

template <typename Get>
double RankOf(const std::vector<ObserverRun>& runs, double fraction, Get get) {
  std::vector<double> values;
  for (const ObserverRun& run : runs) {
    values.push_back(run.escaped ? kInfinity : get(run));
  }
  return Rank(std::move(values), fraction);
}

/// Errors of attitude along a tape into the figures of a run.
void JudgeAttitude(const LinearTape& tape, const std::vector<State>& truth,
                   const ObserverLimits& limits, ObserverRun* run) {
  const double t_end = tape.back().t;
  run->t_settled = tape.epoch(0).t;
  bool settled = true;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    const State& x = tape.epoch(k).x_plus;
    const Eigen::Matrix3d C_true =
        truth[k].C_en().transpose() * truth[k].q_eb.toRotationMatrix();
    const Eigen::Matrix3d C = x.C_en().transpose() * x.q_eb.toRotationMatrix();
    run->tilt = std::atan2(C_true.row(2).cross(C.row(2)).norm(),
                           C_true.row(2).dot(C.row(2)));
    run->heading = std::abs(WrapAngle(truth[k].euler().z() - x.euler().z()));
    const bool inside = run->tilt <= limits.settled_tilt &&
                        run->heading <= limits.settled_heading;
    if (inside && !settled) run->t_settled = tape.epoch(k).t;
    settled = inside;
    if (tape.epoch(k).t >= t_end - limits.last &&
        (run->tilt > limits.diverged_tilt ||
         run->heading > limits.diverged_heading)) {
      run->diverged = true;
    }
  }
  if (!settled) run->t_settled = kInfinity;
}

LyapunovFigures Medians(const std::vector<ObserverRun>& runs) {
  std::vector<LyapunovFigures> all;
  for (const ObserverRun& run : runs) {
    if (!run.escaped) all.push_back(run.lyapunov);
  }
  LyapunovFigures out;
  if (all.empty()) return out;
  for (double LyapunovFigures::*figure :
       {&LyapunovFigures::v_first, &LyapunovFigures::v_last,
        &LyapunovFigures::v_largest, &LyapunovFigures::share_falling,
        &LyapunovFigures::share_falling_early, &LyapunovFigures::radius_first,
        &LyapunovFigures::radius_largest}) {
    std::vector<double> values;
    for (const LyapunovFigures& figures : all) {
      values.push_back(figures.*figure);
    }
    out.*figure = Rank(std::move(values), 0.5);
  }
  out.p_least = kInfinity;
  for (const LyapunovFigures& figures : all) {
    out.p_least = std::min(out.p_least, figures.p_least);
    out.p_largest = std::max(out.p_largest, figures.p_largest);
  }
  return out;
}

ObserverCell Summarize(const std::vector<ObserverRun>& runs) {
  ObserverCell cell;
  cell.runs = static_cast<int>(runs.size());
  std::vector<double> escapes;
  for (const ObserverRun& run : runs) {
    cell.diverged += run.diverged || run.escaped ? 1 : 0;
    cell.escaped += run.escaped ? 1 : 0;
    cell.converged += !run.escaped && std::isfinite(run.t_settled) ? 1 : 0;
    if (run.escaped) escapes.push_back(run.t_escape);
  }
  cell.t_escape = Rank(std::move(escapes), 0.5);
  const auto settled = [](const ObserverRun& run) { return run.t_settled; };
  const auto tilt = [](const ObserverRun& run) { return run.tilt; };
  const auto heading = [](const ObserverRun& run) { return run.heading; };
  cell.t_settled_50 = RankOf(runs, 0.5, settled);
  cell.t_settled_95 = RankOf(runs, 0.95, settled);
  cell.tilt_50 = RankOf(runs, 0.5, tilt);
  cell.tilt_95 = RankOf(runs, 0.95, tilt);
  cell.heading_50 = RankOf(runs, 0.5, heading);
  cell.heading_95 = RankOf(runs, 0.95, heading);
  std::vector<double> information;
  for (const ObserverRun& run : runs) {
    if (run.escaped) continue;
    cell.backed_off += run.backed_off / (cell.runs - cell.escaped);
    information.push_back(run.least_information);
  }
  if (!information.empty()) {
    cell.least_information = Rank(std::move(information), 0.5);
  }
  cell.lyapunov = Medians(runs);
  return cell;
}

Timeline TimelineOf(const Dataset& dataset) {
  TimelineOptions options;
  options.t_begin = dataset.imu.t_begin();
  options.t_end = dataset.imu.t_end();
  Timeline timeline = BuildTimeline(dataset, options);
  const ImuCalibration calibration{dataset.initial.gyro_bias,
                                   dataset.initial.accel_bias};
  for (std::size_t k = 0; k + 1 < timeline.size(); ++k) {
    timeline.Summary(k, calibration);
  }
  return timeline;
}

}  // namespace

ErrorLayout AlignmentLayout(const Dataset& dataset) {
  const InitialState& initial = dataset.initial;
  NavigationPrior prior;
  prior.velocity_sigma = initial.velocity_sigma.value();
  prior.attitude_sigma = initial.attitude_sigma.value();
  prior.gyro_bias_sigma = initial.gyro_bias_sigma.value();
  prior.accel_bias_sigma = initial.accel_bias_sigma.value();
  prior.gyro_bias = dataset.imu.noise.GyroBiasEvolution();
  prior.accel_bias = dataset.imu.noise.AccelBiasEvolution();
  const ErrorLayout all = NavigationLayout(prior);
  ErrorLayout layout;
  for (const Block& block : all.blocks()) {
    if (block.key.kind != BlockKind::kPosition) layout.Add(block);
  }
  return layout;
}

ObserverRun RunObserver(const ForwardModel& model, const Dataset& dataset,
                        const ObserverLimits& limits, Timeline* timeline) {
  const ErrorLayout layout = AlignmentLayout(dataset);
  ObserverRun run;
  try {
    const LinearTape tape = RunForwardFilter(
        model, layout, AlignmentPrior(dataset, layout), timeline);
    std::vector<State> states;
    states.reserve(tape.size());
    for (std::size_t k = 0; k < tape.size(); ++k) {
      states.push_back(tape.epoch(k).x_plus);
    }
    const std::vector<State> truth = TrueStates(dataset, layout, states);
    JudgeAttitude(tape, truth, limits, &run);
    run.backed_off = static_cast<double>(tape.bound().back_offs) /
                     static_cast<double>(tape.size() - 1);
    run.least_information = tape.bound().least_information;
    run.lyapunov = AnalyseRun(tape, model, *timeline, truth);
  } catch (const FiniteEscape& escape) {
    run = {};
    run.escaped = true;
    run.t_escape = escape.t();
  }
  return run;
}

namespace {

/// All cells of one seed, models before starts before recordings.
using ObserverRuns = std::vector<ObserverRun>;

std::vector<ObserverCell> CellsOf(
    const std::vector<ObserverRecording>& recordings,
    const std::vector<ObserverStart>& starts,
    const std::vector<ObserverModel>& models,
    std::span<const ObserverRuns> seeds) {
  std::vector<ObserverCell> out;
  if (seeds.empty()) return out;
  for (const ObserverRecording& recording : recordings) {
    for (const ObserverStart& start : starts) {
      for (const ObserverModel& model : models) {
        std::vector<ObserverRun> runs;
        for (const ObserverRuns& of_seed : seeds) {
          runs.push_back(of_seed[out.size()]);
        }
        ObserverCell cell = Summarize(runs);
        cell.recording = recording.name;
        cell.start = start.name;
        cell.rule = model.rule;
        cell.error = model.model.error;
        out.push_back(std::move(cell));
      }
    }
  }
  return out;
}

}  // namespace

std::vector<ObserverCell> CompareObservers(
    const std::vector<ObserverRecording>& recordings,
    const std::vector<ObserverStart>& starts,
    const std::vector<ObserverModel>& models, const ObserverLimits& limits,
    const MonteCarloOptions& options,
    const Watch<std::vector<ObserverCell>>& watch) {
  const auto runs = std::make_shared<FinishedRuns<ObserverRuns>>(options.runs);
  const auto so_far = [runs, recordings, starts, models] {
    return runs->OfFirst([&](std::span<const ObserverRuns> finished) {
      return CellsOf(recordings, starts, models, finished);
    });
  };
  if (watch) watch(so_far);
  ForEachSeed(options, [&](std::size_t i, std::uint64_t seed) {
    ObserverRuns of_seed;
    for (const ObserverRecording& recording : recordings) {
      Dataset dataset = recording.dataset(seed);
      const Timeline timeline = TimelineOf(dataset);
      for (const ObserverStart& start : starts) {
        start.apply(seed, &dataset);
        for (const ObserverModel& model : models) {
          if (options.stop != nullptr && *options.stop) throw Interrupted();
          // A filter may integrate anew; the next one must not see it.
          Timeline own = timeline;
          of_seed.push_back(RunObserver(model.model, dataset, limits, &own));
        }
      }
    }
    runs->Set(i, std::move(of_seed));
  });
  return so_far();
}

}  // namespace hindsight
