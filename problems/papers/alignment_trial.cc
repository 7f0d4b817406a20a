#include "problems/papers/alignment_trial.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "alignment/alignment_window.h"
#include "base/processor_time.h"
#include "evaluation/statistics.h"
#include "evaluation/true_states.h"
#include "problems/reconstruction.h"

namespace hindsight {
namespace {

/// Errors at every node, as series of the record.
void JudgeAttitude(const Dataset& dataset, const ErrorLayout& layout,
                   const std::vector<State>& states, const CovarianceSeries& P,
                   RunRecord* record) {
  const std::vector<State> truth = TrueStates(dataset, layout, states);
  const int a = layout.Find(BlockKind::kAttitude)->offset;
  auto& series = record->series;
  for (std::size_t k = 0; k < states.size(); ++k) {
    const Eigen::Vector3d e = Local(layout, states[k], truth[k]).segment<3>(a);
    const Eigen::Matrix3d P_k = P.Get(k).block<3, 3>(a, a);
    record->t.push_back(states[k].t);
    series["tilt"].push_back(e.head<2>().norm());
    series["heading"].push_back(std::abs(e.z()));
    series["nees"].push_back(e.dot(P_k.llt().solve(e)));
    series["tilt_sigma"].push_back(std::sqrt(P_k(0, 0) + P_k(1, 1)));
    series["heading_sigma"].push_back(std::sqrt(P_k(2, 2)));
  }
  record->values.emplace_back("states", 3.0);
}

bool IsOff(const AlignmentTrialOptions& trial, double tilt, double heading) {
  return tilt > trial.diverged_tilt || heading > trial.diverged_heading;
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
  JudgeAttitude(dataset, found->refined->layout, found->refined->states,
                found->refined->P, record);
  record->t = {record->t.back()};
  for (auto& [name, series] : record->series) {
    series = {name == "nees" ? series.front() : series.back()};
  }
  record->failed =
      IsOff(trial, record->series["tilt"][0], record->series["heading"][0]);
}

void TryBatch(const Dataset& dataset, const AlignmentTrialOptions& trial,
              RunRecord* record) {
  const double t0 = ProcessorSeconds();
  const Solution solution = Solve(dataset, ReconstructionOptions{});
  record->values = {{kSeconds, ProcessorSeconds() - t0}};
  JudgeAttitude(dataset, solution.layout, solution.states, solution.covariances,
                record);
  record->failed = !solution.converged;
  for (std::size_t k = 0; k < record->t.size(); ++k) {
    if (record->t[k] < record->t.back() - trial.last) continue;
    record->failed = record->failed || IsOff(trial, record->series["tilt"][k],
                                             record->series["heading"][k]);
  }
}

Figure AngleFigure(const std::string& angle) {
  return Several(angle, kDegrees, angle + " [deg]\nrms  worst  sigma  max",
                 "{:.4f}",
                 {{"rms", angle, OfAll<Rms>},
                  {"worst", angle, OfCurve<Largest, Rms>},
                  {"sigma", angle + "_sigma", OfAll<Rms>},
                  {"max", angle, OfAll<Largest>}});
}

}  // namespace

StudyTable AlignmentTable() {
  return {"cells",
          {"method"},
          {FailedFigure(), AngleFigure("tilt"), AngleFigure("heading"),
           Single("anees", kPlain, "ANEES\n(3)", "{:.2f}", "nees",
                  OfCurve<Mean, Mean>),
           AneesBoundFigure("bounds", "{:.2f}"),
           Share("anees_outside", "outside\n[%]", "nees", AneesOutside),
           SecondsFigure()},
          {}};
}

Trial AlignmentTrial(const AlignmentTrialOptions& trial) {
  return [trial](const Dataset& dataset, CaseRun* run) {
    run->Try({"velocity_alignment"},
             [&](RunRecord* record) { TryEarly(dataset, trial, record); });
    run->Try({"velocity_alignment_batch"},
             [&](RunRecord* record) { TryBatch(dataset, trial, record); });
  };
}

}  // namespace hindsight
