#include "problems/papers/alignment_trial.h"

#include <cmath>

#include "alignment/alignment_window.h"
#include "base/error.h"
#include "base/processor_time.h"
#include "evaluation/state_errors.h"
#include "evaluation/statistics.h"
#include "problems/papers/attitude_limits.h"
#include "problems/reconstruction.h"

namespace hindsight {
namespace {

/// The attitude of the last epoch of the window.
StateErrors TryEarly(const Dataset& dataset, double t_early,
                     RunRecord* record) {
  const double t0 = ProcessorSeconds();
  AlignmentInput input{.dataset = dataset,
                       .t = dataset.imu.t_begin(),
                       .to = t_early,
                       .p_e = EcefFromGeodetic(*dataset.initial.position),
                       .fixes = {},
                       .velocities = {},
                       .rest = std::nullopt,
                       .b_g = dataset.initial.gyro_bias,
                       .b_a = dataset.initial.accel_bias};
  input.velocities = GroundVelocities(dataset, input.t, t_early);
  input.gyro_sigma = dataset.initial.gyro_bias_sigma->maxCoeff();
  const auto found = AlignmentWindow(input, t_early).Align(0.0);
  if (!found || !found->refined) throw EstimationError("no alignment");
  record->values = {{kSeconds, ProcessorSeconds() - t0}};
  const WindowSolution& window = *found->refined;
  return ErrorsOf(dataset, window.layout, window.states, window.P,
                  std::vector{window.states.size() - 1});
}

StateErrors TryBatch(const Dataset& dataset, RunRecord* record) {
  const double t0 = ProcessorSeconds();
  const Solution solution = Solve(dataset, ReconstructionOptions{});
  if (!solution.converged) throw EstimationError(solution.verdict);
  record->values = {{kSeconds, ProcessorSeconds() - t0}};
  return ErrorsOf(dataset, solution.layout, solution.states,
                  solution.covariances);
}

void Judge(const StateErrors& errors, RunRecord* record) {
  auto& series = record->series;
  record->t = errors.t;
  series["nees"] = errors.attitude.nees;
  std::vector<double> tilt_sigma, heading_sigma;
  for (std::size_t k = 0; k < errors.t.size(); ++k) {
    const Eigen::Vector3d& e = errors.attitude.e[k];
    const Eigen::Vector3d& sigma = errors.attitude.sigma[k];
    const double tilt = e.head<2>().norm(), heading = std::abs(e.z());
    series["tilt"].push_back(tilt);
    series["heading"].push_back(heading);
    tilt_sigma.push_back(sigma.head<2>().norm());
    heading_sigma.push_back(sigma.z());
    if (errors.t[k] < errors.t.back() - kDecidingEnd) continue;
    record->failed = record->failed || !kDivergedAttitude.Hold(tilt, heading);
  }
  record->values.insert(record->values.end(),
                        {{"states", 3.0},
                         {"tilt", Rms(series["tilt"])},
                         {"heading", Rms(series["heading"])},
                         {"tilt_sigma", Rms(tilt_sigma)},
                         {"heading_sigma", Rms(heading_sigma)}});
}

}  // namespace

Trial AlignmentTrial(double t_early) {
  constexpr auto kEarly = "velocity_alignment";
  constexpr auto kBatch = "velocity_alignment_batch";
  return {Named({kEarly, kBatch}), [=](const Dataset& recording, CaseRun* run) {
            Dataset dataset = recording;
            dataset.initial.alignment = AlignmentKind::kVelocity;
            run->Try({kEarly}, [&](RunRecord* record) {
              Judge(TryEarly(dataset, t_early, record), record);
            });
            run->Try({kBatch}, [&](RunRecord* record) {
              Judge(TryBatch(dataset, record), record);
            });
          }};
}

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

}  // namespace hindsight
