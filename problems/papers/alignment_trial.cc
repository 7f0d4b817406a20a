#include "problems/papers/alignment_trial.h"

#include <algorithm>
#include <cmath>

#include "alignment/alignment_window.h"
#include "base/processor_time.h"
#include "evaluation/state_errors.h"
#include "evaluation/statistics.h"
#include "problems/reconstruction.h"

namespace hindsight {
namespace {

/// Errors of the attitudes into the record; it fails where one of the last
/// seconds is beyond the limits.
void JudgeAttitude(const AlignmentTrialOptions& trial,
                   const StateErrors& errors, RunRecord* record) {
  auto& series = record->series;
  record->t = errors.t;
  series["nees"] = errors.attitude.nees;
  std::vector<double> tilt_sigma, heading_sigma;
  for (std::size_t k = 0; k < errors.t.size(); ++k) {
    const Eigen::Vector3d& e = errors.attitude.e[k];
    const Eigen::Vector3d& sigma = errors.attitude.sigma[k];
    series["tilt"].push_back(e.head<2>().norm());
    series["heading"].push_back(std::abs(e.z()));
    tilt_sigma.push_back(sigma.head<2>().norm());
    heading_sigma.push_back(sigma.z());
    record->failed =
        record->failed || (errors.t[k] >= errors.t.back() - trial.last &&
                           (series["tilt"].back() > trial.diverged_tilt ||
                            series["heading"].back() > trial.diverged_heading));
  }
  record->values.insert(record->values.end(),
                        {{"states", 3.0},
                         {"tilt", Rms(series["tilt"])},
                         {"heading", Rms(series["heading"])},
                         {"tilt_sigma", Rms(tilt_sigma)},
                         {"heading_sigma", Rms(heading_sigma)}});
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
void TryEarly(const Dataset& dataset, const AlignmentTrialOptions& trial,
              RunRecord* record) {
  const double t0 = ProcessorSeconds();
  const auto found =
      AlignmentWindow(InputOf(dataset, trial.t_early), trial.t_early)
          .Align(0.0);
  record->values = {{kSeconds, ProcessorSeconds() - t0}};
  if (!found || !found->refined) return record->Fail();
  const WindowSolution& window = *found->refined;
  const auto errors_at = [&](std::size_t k) {
    return ErrorsOf(dataset, window.layout, window.states, window.P,
                    std::vector{k});
  };
  StateErrors errors = errors_at(window.states.size() - 1);
  errors.attitude.nees = errors_at(0).attitude.nees;
  JudgeAttitude(trial, errors, record);
}

void TryBatch(const Dataset& dataset, const AlignmentTrialOptions& trial,
              RunRecord* record) {
  const double t0 = ProcessorSeconds();
  const Solution solution = Solve(dataset, ReconstructionOptions{});
  record->values = {{kSeconds, ProcessorSeconds() - t0}};
  record->failed = !solution.converged;
  JudgeAttitude(
      trial,
      ErrorsOf(dataset, solution.layout, solution.states, solution.covariances),
      record);
}

}  // namespace

StudyTable AlignmentTable() {
  StudyTable table = {"cells", {"method"}};
  table.Add({FailedFigure()});
  for (const std::string angle : {"tilt", "heading"}) {
    table.Add(
        {{angle + "_rms", kDegrees, OfRuns(Rms), angle},
         {angle + "_worst", kDegrees, OfCurve(Largest, SeriesFold::Rms), angle},
         {angle + "_sigma", kDegrees, OfRuns(Rms)}});
  }
  table.Add({{"anees", kPlain, OfCurve(Mean, SeriesFold::Mean), "nees"}});
  table.AddAneesBounds();
  table.Add({{"anees_outside", kPlain, AneesOutside, "nees"}, SecondsFigure()});
  return table;
}

Trial AlignmentTrial(const AlignmentTrialOptions& trial) {
  constexpr auto kEarly = "velocity_alignment";
  constexpr auto kBatch = "velocity_alignment_batch";
  return {Named({kEarly, kBatch}), [=](const Dataset& dataset, CaseRun* run) {
            run->Try({kEarly}, [&](RunRecord* record) {
              TryEarly(dataset, trial, record);
            });
            run->Try({kBatch}, [&](RunRecord* record) {
              TryBatch(dataset, trial, record);
            });
          }};
}

}  // namespace hindsight
