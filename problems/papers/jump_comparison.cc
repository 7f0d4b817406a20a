#include "problems/papers/jump_comparison.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "base/processor_time.h"
#include "dataset/timeline_builder.h"
#include "evaluation/statistics.h"
#include "evaluation/true_states.h"
#include "filters/imm_smoother.h"
#include "problems/position_imm.h"
#include "problems/reconstruction.h"

namespace hindsight {
namespace {

constexpr double kSettledAfter = 10.0;  // [s]

/// Of one method into its record; `P` is over a layout whose first two
/// components are the position north and east.
void JudgeJumps(const Dataset& dataset, const std::vector<State>& states,
                const CovarianceSeries& P, RunRecord* record) {
  const std::vector<State> truth = TrueStates(dataset, ErrorLayout{}, states);
  auto& series = record->series;
  for (std::size_t k = 0; k < states.size(); ++k) {
    const State& x = states[k];
    const Eigen::Vector2d e =
        (x.C_en().transpose() * (truth[k].p_e - x.p_e)).head<2>();
    const Eigen::Vector2d v = (truth[k].v_n() - x.v_n()).head<2>();
    const Eigen::Matrix2d P_h = P.Get(k).topLeftCorner<2, 2>();
    record->t.push_back(x.t);
    series["position_n"].push_back(e.x());
    series["position_e"].push_back(e.y());
    series["velocity_n"].push_back(v.x());
    series["velocity_e"].push_back(v.y());
    series["nees_horizontal"].push_back(e.dot(P_h.llt().solve(e)));
  }
}

void KeepProbabilities(const ImmTrajectory& trajectory, RunRecord* record) {
  for (const Eigen::VectorXd& modes : trajectory.probabilities) {
    for (Eigen::Index j = 0; j < modes.size(); ++j) {
      record->series["probability_" + std::to_string(j)].push_back(modes(j));
    }
  }
}

/// The filters of the paper, on one timeline.
void TryPaper(const Dataset& dataset, CaseRun* run) {
  constexpr double kForever = std::numeric_limits<double>::infinity();
  Start start = FindStart(dataset, -kForever, kForever);
  TimelineOptions timeline_options;
  timeline_options.t_begin = start.report.t;
  timeline_options.t_end = dataset.imu.t_end();
  timeline_options.with_scale_jacobians = true;
  Timeline timeline = BuildTimeline(dataset, timeline_options);
  start.prior.x.t = timeline.node(0).t;
  const auto attempt = [&](const std::string& name, const auto& filter) {
    run->Try({name}, [&](RunRecord* record) {
      const double t0 = ProcessorSeconds();
      const ImmTrajectory trajectory = filter();
      record->values = {{kSeconds, ProcessorSeconds() - t0}};
      JudgeJumps(dataset, trajectory.states, trajectory.P, record);
      KeepProbabilities(trajectory, record);
    });
  };
  const PositionImmOptions both;
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

/// Root mean square of an axis of a quantity with north and east parts, when
/// the filters have forgotten the start.
double AxisRms(const RunCell& cell, const std::string& quantity,
               const TimeRange& range) {
  return std::hypot(Rms(cell.Pooled(quantity + "_n", range)),
                    Rms(cell.Pooled(quantity + "_e", range))) /
         std::sqrt(2.0);
}

}  // namespace

StudyTable JumpTable() {
  constexpr Unit kSpeed = {"m/s", 1.0};
  StudyTable table = {"cells", {"method"}, {}, {}};
  table.figures = {
      Single("position_rms", kMetres, "position, an axis\nrms from 10 s on [m]",
             "{:.3f}", "position", AxisRms),
      Single("velocity_rms", kSpeed, "velocity\n[m/s]", "{:.3f}", "velocity",
             AxisRms),
      Single("anees_horizontal", kPlain, "ANEES\n(2)", "{:.1f}",
             "nees_horizontal", OfAll<Mean>),
      FailedFigure(), SecondsFigure()};
  for (Figure& figure : table.figures) figure.range.from = kSettledAfter;
  table.curves = {{"position_rms_n", kMetres, "position_n", Rms},
                  {"position_rms_e", kMetres, "position_e", Rms},
                  {"velocity_rms_n", kSpeed, "velocity_n", Rms},
                  {"velocity_rms_e", kSpeed, "velocity_e", Rms},
                  {"anees_horizontal", kPlain, "nees_horizontal", Mean},
                  {"probability_0", kPlain, "probability_0", Mean},
                  {"probability_1", kPlain, "probability_1", Mean}};
  return table;
}

Trial JumpTrial() {
  return [](const Dataset& dataset, CaseRun* run) {
    TryPaper(dataset, run);
    Reconstruction reconstruction(dataset, {});
    for (const std::string method :
         {"gated_ekf", "rts", "batch", "robust_batch"}) {
      run->Try({method}, [&](RunRecord* record) {
        const Solution solution = reconstruction.Run(method);
        record->failed = !solution.converged;
        record->answered = solution.converged;
        if (!solution.converged) return;
        // Modes may differ from seed to seed: no mean of them.
        JudgeJumps(dataset, solution.states, solution.covariances, record);
        record->values = {{kSeconds, solution.seconds}};
      });
    }
  };
}

}  // namespace hindsight
