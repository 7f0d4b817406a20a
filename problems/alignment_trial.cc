#include "problems/alignment_trial.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <memory>
#include <tuple>
#include <utility>

#include "alignment/alignment_window.h"
#include "base/error.h"
#include "base/processor_time.h"

namespace hindsight {
namespace {

/// Errors of one run, an entry a node.
struct TrialRun {
  bool failed = true;
  std::vector<double> tilt, heading, nees;
  std::vector<double> tilt_sigma, heading_sigma;
  double seconds = 0.0;
};

void JudgeTrial(const Dataset& dataset, const ErrorLayout& layout,
                const std::vector<State>& states, const CovarianceSeries& P,
                TrialRun* run) {
  const std::vector<State> truth = TrueStates(dataset, layout, states);
  const int a = layout.Find(BlockKind::kAttitude)->offset;
  for (std::size_t k = 0; k < states.size(); ++k) {
    const Eigen::Vector3d e = Local(layout, states[k], truth[k]).segment<3>(a);
    const Eigen::Matrix3d P_k = P.Get(k).block<3, 3>(a, a);
    run->tilt.push_back(e.head<2>().norm());
    run->heading.push_back(std::abs(e.z()));
    run->nees.push_back(e.dot(P_k.llt().solve(e)));
    run->tilt_sigma.push_back(std::sqrt(P_k(0, 0) + P_k(1, 1)));
    run->heading_sigma.push_back(std::sqrt(P_k(2, 2)));
  }
}

AlignmentInput InputOf(const Dataset& dataset, double to) {
  AlignmentInput input{.dataset = dataset,
                       .t = dataset.imu.t_begin(),
                       .to = to,
                       .p_e = EcefFromGeodetic(*dataset.initial.position),
                       .fixes = {},
                       .velocities = {},
                       .rest = std::nullopt,
                       .b_g = dataset.initial.gyro_bias,
                       .b_a = dataset.initial.accel_bias};
  input.velocities = GroundVelocities(dataset, input.t, to);
  input.gyro_sigma = dataset.initial.gyro_bias_sigma->maxCoeff();
  return input;
}

/// The attitude of the first epoch for the consistency, that of the last for
/// the errors.
TrialRun TryEarly(const Dataset& dataset, const AlignmentTrialOptions& trial) {
  TrialRun run;
  const double t0 = ProcessorSeconds();
  const auto found =
      AlignmentWindow(InputOf(dataset, trial.t_early), trial.t_early)
          .Align(0.0);
  run.seconds = ProcessorSeconds() - t0;
  if (!found || !found->refined) return run;
  JudgeTrial(dataset, found->refined->layout, found->refined->states,
             found->refined->P, &run);
  run.nees = {run.nees.front()};
  for (std::vector<double> TrialRun::*series :
       {&TrialRun::tilt, &TrialRun::heading, &TrialRun::tilt_sigma,
        &TrialRun::heading_sigma}) {
    run.*series = {(run.*series).back()};
  }
  run.failed = run.tilt.back() > trial.diverged_tilt ||
               run.heading.back() > trial.diverged_heading;
  return run;
}

TrialRun TryBatch(const Dataset& dataset, const AlignmentTrialOptions& trial) {
  TrialRun run;
  const double t0 = ProcessorSeconds();
  try {
    const Solution solution = Solve(dataset, ReconstructionOptions{});
    run.seconds = ProcessorSeconds() - t0;
    JudgeTrial(dataset, solution.layout, solution.states, solution.covariances,
               &run);
    run.failed = !solution.converged;
    const double t_end = solution.states.back().t;
    for (std::size_t k = 0; k < solution.states.size(); ++k) {
      if (solution.states[k].t < t_end - trial.last) continue;
      run.failed = run.failed || run.tilt[k] > trial.diverged_tilt ||
                   run.heading[k] > trial.diverged_heading;
    }
  } catch (const EstimationError&) {
    run.failed = true;
  }
  return run;
}

AlignmentStatistics::Angle SummarizeAngle(
    const std::vector<TrialRun>& runs, std::size_t epochs,
    std::vector<double> TrialRun::*error,
    std::vector<double> TrialRun::*sigma) {
  AlignmentStatistics::Angle out;
  double square = 0.0, variance = 0.0, count = 0.0;
  for (std::size_t k = 0; k < epochs; ++k) {
    double at_epoch = 0.0, finished = 0.0;
    for (const TrialRun& run : runs) {
      if (run.nees.empty()) continue;
      const double e = (run.*error)[k];
      at_epoch += e * e;
      variance += std::pow((run.*sigma)[k], 2);
      out.largest = std::max(out.largest, e);
      finished += 1.0;
    }
    square += at_epoch;
    count += finished;
    out.worst = std::max(out.worst, std::sqrt(at_epoch / finished));
  }
  if (count == 0.0) return out;
  out.rms = std::sqrt(square / count);
  out.sigma = std::sqrt(variance / count);
  return out;
}

AlignmentStatistics Summarize(const std::vector<TrialRun>& runs,
                              const MonteCarloOptions& options) {
  AlignmentStatistics out;
  out.runs = static_cast<int>(runs.size());
  std::size_t nodes = 0;
  for (const TrialRun& run : runs) {
    nodes = std::max(nodes, run.nees.size());
    if (run.failed) ++out.failed;
    if (!run.nees.empty()) ++out.answered;
    out.seconds += run.seconds / static_cast<double>(runs.size());
  }
  if (out.answered == 0) return out;
  std::tie(out.anees_lower, out.anees_upper) =
      options.anees_bounds(out.answered, 3);
  out.tilt =
      SummarizeAngle(runs, nodes, &TrialRun::tilt, &TrialRun::tilt_sigma);
  out.heading =
      SummarizeAngle(runs, nodes, &TrialRun::heading, &TrialRun::heading_sigma);
  for (std::size_t k = 0; k < nodes; ++k) {
    double nees = 0.0;
    for (const TrialRun& run : runs) {
      if (!run.nees.empty()) nees += run.nees[k] / out.answered;
    }
    out.anees += nees / static_cast<double>(nodes);
    const bool outside = nees < out.anees_lower || nees > out.anees_upper;
    out.anees_outside += (outside ? 1.0 : 0.0) / static_cast<double>(nodes);
  }
  return out;
}

/// Both ways on one recording.
struct Trial {
  TrialRun early, batch;
};

std::vector<AlignmentStatistics> StatisticsOf(
    const std::vector<AlignmentRecording>& recordings,
    const MonteCarloOptions& options,
    std::span<const std::vector<Trial>> trials) {
  std::vector<AlignmentStatistics> out;
  if (trials.empty()) return out;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    for (const auto& [name, way] :
         {std::pair("velocity_alignment", &Trial::early),
          std::pair("velocity_alignment_batch", &Trial::batch)}) {
      std::vector<TrialRun> runs;
      for (const std::vector<Trial>& trial : trials) {
        runs.push_back(trial[r].*way);
      }
      out.push_back(Summarize(runs, options));
      out.back().name = name;
      out.back().recording = recordings[r].name;
    }
  }
  return out;
}

}  // namespace

std::vector<AlignmentStatistics> TryAlignment(
    const std::vector<AlignmentRecording>& recordings,
    const AlignmentTrialOptions& trial, const MonteCarloOptions& options,
    const Watch<std::vector<AlignmentStatistics>>& watch) {
  const auto trials =
      std::make_shared<FinishedRuns<std::vector<Trial>>>(options.runs);
  const auto so_far = [trials, recordings, options] {
    return trials->OfFirst([&](std::span<const std::vector<Trial>> finished) {
      return StatisticsOf(recordings, options, finished);
    });
  };
  if (watch) watch(so_far);
  ForEachSeed(options, [&](std::size_t i, std::uint64_t seed) {
    std::vector<Trial> of_seed;
    for (const AlignmentRecording& recording : recordings) {
      if (options.stop != nullptr && *options.stop) throw Interrupted();
      const Dataset dataset = recording.dataset(seed);
      of_seed.push_back({TryEarly(dataset, trial), TryBatch(dataset, trial)});
    }
    trials->Set(i, std::move(of_seed));
  });
  return so_far();
}

}  // namespace hindsight
