#include "problems/papers/alignment_trial.h"

#include <algorithm>

#include "alignment/alignment_window.h"
#include "base/error.h"
#include "evaluation/statistics.h"
#include "problems/papers/attitude_limits.h"
#include "problems/reconstruction.h"

namespace hindsight {
namespace {

/// The last epoch of the window.
Solution Early(const Dataset& dataset, double t_early) {
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
  Solution solution;
  solution.layout = found->refined->layout;
  solution.states = {found->refined->states.back()};
  solution.covariances = CovarianceSeries(solution.layout.dim(), 1);
  solution.covariances.Set(
      0, found->refined->P.Get(found->refined->states.size() - 1));
  return solution;
}

bool Diverged(const StateErrors& errors) {
  const PartErrors last = errors.Within(
      &StateErrors::attitude, {.from = errors.t.back() - kDecidingEnd});
  const std::vector<double> heading = last.Down();
  return !kDivergedAttitude.Hold(Largest(last.Level()),
                                 std::max(Largest(heading), -Least(heading)));
}

/// Of what is stated.
template <double (*rms)(const PartErrors&)>
double Sigma(const PartErrors& part) {
  return rms({part.sigma, {}, {}});
}

}  // namespace

StudyTable AlignmentTable() {
  constexpr auto kRms = SeriesFold::Rms;
  const auto attitude = &StateErrors::attitude;
  const auto measured = [&](const char* name, auto statistic) {
    return Measured(name, kDegrees, Rms, OfPart(attitude, statistic));
  };
  StudyTable table = {"cells", {"method"}};
  table.series = {{"tilt", [](const auto& e) { return e.attitude.Level(); }},
                  {"heading", [](const auto& e) { return e.attitude.Down(); }},
                  {"nees", [](const auto& e) { return e.attitude.nees; }}};
  table.Add({FailedFigure(),
             measured("tilt_rms", LevelRms),
             {"tilt_worst", kDegrees, OfCurve(Largest, kRms), "tilt"},
             measured("tilt_sigma", Sigma<LevelRms>),
             measured("heading_rms", DownRms),
             {"heading_worst", kDegrees, OfCurve(Largest, kRms), "heading"},
             measured("heading_sigma", Sigma<DownRms>),
             {"anees", kPlain, OfCurve(Mean, SeriesFold::Mean), "nees"}});
  table.AddAneesBounds();
  table.Add({{"anees_outside", kPlain, AneesOutside, "nees"}});
  return table;
}

Trial AlignmentTrial(double t_early) {
  constexpr auto kEarly = "velocity_alignment";
  constexpr auto kBatch = "velocity_alignment_batch";
  return {Named({kEarly, kBatch}), [=, table = AlignmentTable()](
                                       const Dataset& recording, CaseRun* run) {
            Dataset dataset = recording;
            dataset.initial.alignment = AlignmentKind::kVelocity;
            for (const char* method : {kEarly, kBatch}) {
              run->Try({method}, [&](RunRecord* record) {
                const Solution solution = method == kEarly
                                              ? Early(dataset, t_early)
                                              : Solve(dataset, {});
                if (!solution.converged) return record->Fail();
                const StateErrors errors = ErrorsOf(dataset, solution);
                record->values = {{"states", 3.0}};
                record->failed = Diverged(errors);
                table.Record(errors, record);
              });
            }
          }};
}

}  // namespace hindsight
