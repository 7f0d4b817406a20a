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
  std::vector<double> position, velocity, nees;
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
    if (x.t < kSettledAfter) continue;
    position.push_back(e.norm());
    velocity.push_back(v.norm());
    nees.push_back(series["nees_horizontal"].back());
  }
  record->values.insert(record->values.end(),
                        {{"position_rms", Rms(position) / std::sqrt(2.0)},
                         {"velocity_rms", Rms(velocity) / std::sqrt(2.0)},
                         {"anees_horizontal", Mean(nees)}});
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

void TryOurs(const Dataset& dataset, CaseRun* run) {
  Reconstruction reconstruction(dataset, {});
  for (const std::string method :
       {"gated_ekf", "rts", "batch", "robust_batch"}) {
    run->Try({method}, [&](RunRecord* record) {
      const Solution solution = reconstruction.Run(method);
      if (!solution.converged) return record->Fail();
      // Modes may differ from seed to seed: no mean of them.
      record->values = {{kSeconds, solution.seconds}};
      JudgeJumps(dataset, solution.states, solution.covariances, record);
    });
  }
}

}  // namespace

StudyTable JumpTable() {
  constexpr Unit kSpeed = {"m/s", 1.0};
  StudyTable table = {"cells", {"method"}};
  table.Add({{"position_rms", kMetres, OfRuns(Rms)},
             {"velocity_rms", kSpeed, OfRuns(Rms)},
             {"anees_horizontal", kPlain, OfRuns(Mean)},
             FailedFigure(),
             SecondsFigure()});
  table.curves = {
      {"position_rms_n", kMetres, "position_n", SeriesFold::Rms},
      {"position_rms_e", kMetres, "position_e", SeriesFold::Rms},
      {"velocity_rms_n", kSpeed, "velocity_n", SeriesFold::Rms},
      {"velocity_rms_e", kSpeed, "velocity_e", SeriesFold::Rms},
      {"anees_horizontal", kPlain, "nees_horizontal", SeriesFold::Mean},
      {"probability_0", kPlain, "probability_0", SeriesFold::Mean},
      {"probability_1", kPlain, "probability_1", SeriesFold::Mean}};
  return table;
}

Trial JumpTrial() {
  return {Named({"kf0", "kf1", "imm", "imm_smoother", "gated_ekf", "rts",
                 "batch", "robust_batch"}),
          [](const Dataset& dataset, CaseRun* run) {
            TryPaper(dataset, run);
            TryOurs(dataset, run);
          }};
}

}  // namespace hindsight
