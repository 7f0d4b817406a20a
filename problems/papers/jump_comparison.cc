#include "problems/papers/jump_comparison.h"

#include <cmath>
#include <limits>
#include <tuple>

#include "base/processor_time.h"
#include "dataset/timeline_builder.h"
#include "evaluation/statistics.h"
#include "filters/imm_smoother.h"
#include "problems/navigation_trial.h"
#include "problems/position_imm.h"

namespace hindsight {
namespace {

double HorizontalAxisRms(const PartErrors& part) {
  return LevelRms(part) / std::sqrt(2.0);
}

/// The filters of the paper, on one timeline.
void TryPaper(const StudyTable& table, const Dataset& dataset, CaseRun* run) {
  constexpr double kForever = std::numeric_limits<double>::infinity();
  Start start = FindStart(dataset, -kForever, kForever);
  TimelineOptions timeline_options;
  timeline_options.t_begin = start.report.t;
  timeline_options.t_end = dataset.imu.t_end();
  timeline_options.with_scale_jacobians = true;
  Timeline timeline = BuildTimeline(dataset, timeline_options);
  start.prior.x.t = timeline.node(0).t;
  const PositionImmOptions both;
  const ErrorLayout layout =
      PositionImmModels(dataset, start, both).front().layout;
  const auto attempt = [&](const std::string& name, const auto& filter) {
    run->Try({name}, [&](RunRecord* record) {
      const double t0 = ProcessorSeconds();
      const ImmTrajectory trajectory = filter();
      Solution solution;
      solution.layout = layout;
      solution.states = trajectory.states;
      solution.covariances = trajectory.P;
      record->values = {{kSeconds, ProcessorSeconds() - t0}};
      table.Record(ErrorsOf(dataset, solution), record);
      for (const Eigen::VectorXd& modes : trajectory.probabilities) {
        for (Eigen::Index j = 0; j < modes.size(); ++j) {
          record->series["probability_" + std::to_string(j)].push_back(
              modes(j));
        }
      }
    });
  };
  for (std::size_t i = 0; i < both.amplitudes.size(); ++i) {
    PositionImmOptions single = both;
    single.amplitudes = {both.amplitudes[i]};
    attempt("kf" + std::to_string(i), [&] {
      return RunPositionImm(dataset, start, single, &timeline).trajectory;
    });
  }
  ImmResult result;
  attempt("imm", [&] {
    result = RunPositionImm(dataset, start, both, &timeline);
    return result.trajectory;
  });
  attempt("imm_smoother", [&] { return SmoothImm(result.tape).trajectory; });
}

}  // namespace

StudyTable JumpTable() {
  constexpr Unit kSpeed = {"m/s", 1.0};
  const TimeRange settled = {.from = 10.0};
  const auto position = &StateErrors::horizontal;
  const auto velocity = &StateErrors::horizontal_velocity;
  StudyTable table = {"cells", {"method"}};
  table.Add({Measured("position_rms", kMetres, Rms,
                      OfPart(position, HorizontalAxisRms, settled)),
             Measured("velocity_rms", kSpeed, Rms,
                      OfPart(velocity, HorizontalAxisRms, settled)),
             Measured("anees_horizontal", kPlain, Mean,
                      OfPart(position, MeanNees, settled)),
             FailedFigure(), SecondsFigure()});
  for (const int axis : {0, 1}) {
    const std::string end = axis == 0 ? "_n" : "_e";
    for (const auto& [name, unit, part] :
         {std::tuple("position", kMetres, position),
          {"velocity", kSpeed, velocity}}) {
      const std::string quantity = name + end;
      table.series.emplace_back(quantity, [axis, part = part](const auto& e) {
        return (e.*part).Component(axis);
      });
      table.curves.push_back(
          {name + ("_rms" + end), unit, quantity, SeriesFold::Rms});
    }
    const std::string mode = "probability_" + std::to_string(axis);
    table.curves.push_back({mode, kPlain, mode, SeriesFold::Mean});
  }
  return table;
}

Trial JumpTrial() {
  const Trial ours = NavigationTrialOf(
      {.methods = {"gated_ekf", "rts", "batch", "robust_batch"},
       .cells = JumpTable()});
  return {Named({"kf0", "kf1", "imm", "imm_smoother", "gated_ekf", "rts",
                 "batch", "robust_batch"}),
          [ours, table = JumpTable()](const Dataset& dataset, CaseRun* run) {
            TryPaper(table, dataset, run);
            ours.run(dataset, run);
          }};
}

}  // namespace hindsight
