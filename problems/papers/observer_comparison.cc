#include "problems/papers/observer_comparison.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "alignment/given.h"
#include "alignment/start.h"
#include "base/error.h"
#include "dataset/timeline_builder.h"
#include "evaluation/statistics.h"
#include "evaluation/true_states.h"
#include "problems/papers/attitude_limits.h"

namespace hindsight {
namespace {

using RunValues = std::vector<std::pair<std::string, double>>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Of the attitude along a tape: whether the run diverged and how it settled.
RunValues JudgeAttitude(const LinearTape& tape,
                        const std::vector<State>& truth) {
  bool settled = true, diverged = false;
  double t_settled = tape.t(0), tilt = 0.0, heading = 0.0;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    const State& x = tape.epoch(k).x_plus;
    const double t = tape.t(k);
    const Eigen::Matrix3d C_true =
        truth[k].C_en().transpose() * truth[k].q_eb.toRotationMatrix();
    const Eigen::Matrix3d C = x.C_en().transpose() * x.q_eb.toRotationMatrix();
    tilt = std::atan2(C_true.row(2).cross(C.row(2)).norm(),
                      C_true.row(2).dot(C.row(2)));
    heading = std::abs(WrapAngle(truth[k].euler().z() - x.euler().z()));
    const bool inside = kSettledAttitude.Hold(tilt, heading);
    if (inside && !settled) t_settled = t;
    settled = inside;
    diverged = diverged || (t >= tape.back().t - kDecidingEnd &&
                            !kDivergedAttitude.Hold(tilt, heading));
  }
  return {{"diverged", diverged ? 1.0 : 0.0},
          {"escaped", 0.0},
          {"converged", settled ? 1.0 : 0.0},
          {"t_settled", settled ? t_settled : kInfinity},
          {"tilt", tilt},
          {"heading", heading}};
}

constexpr double kEvery = 1.0;  // eigenvalues are taken so often [s]
/// A rate below this is rounding: no decay is guaranteed [1/s].
constexpr double kLeastRate = 1e-9;

Eigen::VectorXd Eigenvalues(const Eigen::MatrixXd& M) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(M,
                                                        Eigen::EigenvaluesOnly)
      .eigenvalues();
}

/// Largest eigenvalue of the diagonal block of a kind, zero without it.
double LargestOf(const ErrorLayout& layout, const ErrorMatrix& M,
                 BlockKind kind) {
  const Block* block = layout.Find(kind);
  if (block == nullptr) return 0.0;
  return Eigenvalues(
             M.block(block->offset, block->offset, block->dim, block->dim))
      .maxCoeff();
}

/// Share of the steps from one value to the next that fall.
double ShareFalling(const std::vector<double>& values) {
  double falling = 0.0;
  for (std::size_t k = 1; k < values.size(); ++k) {
    if (values[k] < values[k - 1]) falling += 1.0;
  }
  return falling / std::max(1.0, static_cast<double>(values.size()) - 1.0);
}

/// The paper's analysis along a tape, `truth` being at its epochs: see
/// RunObserver.
struct Analysis {
  const LinearTape& tape;
  const ErrorLayout& layout;
  ErrorDefinition error;
  CovariancePolicy policy;
  const Timeline& timeline;
  const std::vector<State>& truth;

  RunValues Run() const {
    std::vector<double> V, radii;
    double next = 0.0;
    for (std::size_t k = 0; k < tape.size(); ++k) {
      const TapeEpoch& epoch = tape.epoch(k);
      const ErrorMatrix P = tape.P_plus(k);
      const ErrorVector e = Local(error, layout, epoch.x_plus, truth[k]);
      V.push_back(e.dot(P.llt().solve(e)));
      if (k == 0 || epoch.t < next) continue;
      next = epoch.t + kEvery - 1e-6;
      radii.push_back(Radius(k, P));
    }
    const auto guaranteed = std::ranges::find_if(
        radii, [](double radius) { return radius != 0.0; });
    return {{"v_first", V.front()},
            {"v_last", V.back()},
            {"v_largest", Largest(V)},
            {"share_falling", ShareFalling(V)},
            {"radius_first", guaranteed == radii.end() ? 0.0 : *guaranteed},
            {"radius_largest", Largest(radii)}};
  }

  /// mu: P^1/2 M P^1/2 with the Cholesky factor of P for its root.
  double DecayRate(std::size_t k, const ErrorMatrix& P, double dt) const {
    const ErrorMatrix root = P.llt().matrixL();
    const ErrorMatrix inverse = root.triangularView<Eigen::Lower>().solve(
        ErrorMatrix::Identity(P.rows(), P.rows()));
    ErrorMatrix M = inverse * (tape.Q(k) / dt) * inverse.transpose();
    ErrorMatrix information = policy.WeightMatrix();
    for (const TapeMeasurement& z : tape.measurements(k)) {
      if (!z.accepted) continue;
      const Eigen::MatrixXd R = z.R;
      information += z.H.transpose() * R.llt().solve(z.H) / dt;
    }
    M += root.transpose() * information * root;
    if (policy.alpha().size() > 0) {
      const ErrorMatrix S =
          root.transpose() * policy.alpha().asDiagonal() * inverse.transpose();
      M += S + S.transpose();
    }
    const double mu = Eigenvalues(M).minCoeff();
    return mu > kLeastRate ? mu : 0.0;
  }

  double Radius(std::size_t k, const ErrorMatrix& P) const {
    const double dt = tape.t(k) - tape.t(k - 1);
    const ErrorMatrix information =
        P.llt().solve(ErrorMatrix::Identity(P.rows(), P.rows()));
    const auto largest = [&](const ErrorMatrix& M, BlockKind kind) {
      return LargestOf(layout, M, kind);
    };
    const double psi = largest(P, BlockKind::kAttitude);
    const double gyro = largest(P, BlockKind::kGyroBias);
    const double accel = largest(P, BlockKind::kAccelBias);
    const double on_v = std::sqrt(largest(information, BlockKind::kVelocity));
    const double on_psi = std::sqrt(largest(information, BlockKind::kAttitude));
    const double f = timeline.node(k).kinematics.f_b.norm();
    double c = on_v * std::sqrt(psi * accel) + on_psi * std::sqrt(psi * gyro);
    if (error == ErrorDefinition::kLeftInvariant) {
      c += on_v * std::sqrt(largest(P, BlockKind::kVelocity) * gyro);
    } else {
      c += on_v * 0.5 * f * psi;
    }
    return DecayRate(k, P, dt) / (2.0 * c) / on_psi;
  }
};

}  // namespace

Problem AlignmentProblem(const Dataset& dataset) {
  const Start start = FindStart(dataset, -kInfinity, kInfinity);
  TimelineOptions options;
  options.t_begin = start.report.t;
  options.t_end = dataset.imu.t_end();
  Problem problem = {{}, {start.prior.x, {}}, BuildTimeline(dataset, options)};
  for (const Block& block : start.layout.blocks()) {
    if (block.key.kind != BlockKind::kPosition) problem.layout.Add(block);
  }
  // A start gives no angle a sigma beyond that of which nothing is known; the
  // paper's filters take what is given at its word.
  problem.prior.P = problem.layout.InitialCovariance();
  const int attitude = problem.layout.Find(BlockKind::kAttitude)->offset;
  problem.prior.P.block<3, 3>(attitude, attitude) = AttitudeCovariance(
      *dataset.initial.euler, *dataset.initial.attitude_sigma);
  const ImuCalibration calibration{start.prior.x.b_g, start.prior.x.b_a};
  for (std::size_t k = 0; k + 1 < problem.timeline.size(); ++k) {
    problem.timeline.Integrate(k, calibration);
  }
  return problem;
}

RunValues RunObserver(const ForwardModel& model, const Dataset& dataset,
                      Problem problem) {
  const ErrorLayout& layout = problem.layout;
  try {
    const LinearTape tape = RunForwardFilter(model, &problem);
    std::vector<State> states;
    states.reserve(tape.size());
    for (std::size_t k = 0; k < tape.size(); ++k) {
      states.push_back(tape.epoch(k).x_plus);
    }
    const std::vector<State> truth = TrueStates(dataset, layout, states);
    RunValues values = JudgeAttitude(tape, truth);
    values.emplace_back("backed_off",
                        static_cast<double>(tape.bound().back_offs) /
                            static_cast<double>(tape.size() - 1));
    values.emplace_back("least_information", tape.bound().least_information);
    const Analysis analysis = {
        tape, layout, model.error, {model.covariance, layout}, problem.timeline,
        truth};
    std::ranges::move(analysis.Run(), std::back_inserter(values));
    return values;
  } catch (const FiniteEscape& escape) {
    return {{"diverged", 1.0},       {"escaped", 1.0},
            {"converged", 0.0},      {"t_settled", kInfinity},
            {"tilt", kInfinity},     {"heading", kInfinity},
            {"t_escape", escape.t()}};
  }
}

StudyTable ObserverTable() {
  constexpr Unit kInSeconds = {"s", 1.0};
  StudyTable table = {"cells", {"rule", "error"}};
  table.Add({{"diverged", kPlain, OfRuns(Mean)},
             {"escaped", kPlain, OfRuns(Mean)},
             {"t_escape", kInSeconds, OfRuns(Rank50)},
             {"converged", kPlain, OfRuns(Mean)}});
  for (const auto& [name, unit] : {std::pair("t_settled", kInSeconds),
                                   {"tilt", kDegrees},
                                   {"heading", kDegrees}}) {
    table.Add({{std::string(name) + "_50", unit, OfRuns(Rank50), name},
               {std::string(name) + "_95", unit, OfRuns(Rank95), name}});
  }
  table.Add({{"backed_off", kPlain, OfRuns(Mean)}});
  for (const char* name : {"least_information", "v_first", "v_largest",
                           "v_last", "share_falling"}) {
    table.Add({{name, kPlain, OfRuns(Rank50)}});
  }
  for (const char* name : {"radius_first", "radius_largest"}) {
    table.Add({{name, kDegrees, OfRuns(Rank50)}});
  }
  return table;
}

Trial ObserverTrial(const std::vector<ObserverModel>& models) {
  Trial trial;
  for (const ObserverModel& model : models) {
    trial.methods.push_back({model.rule, ErrorName(model.model.error)});
  }
  trial.run = [=, methods = trial.methods](const Dataset& dataset,
                                           CaseRun* run) {
    const Problem problem = AlignmentProblem(dataset);
    for (std::size_t i = 0; i < models.size(); ++i) {
      run->Try(methods[i], [&](RunRecord* record) {
        record->values = RunObserver(models[i].model, dataset, problem);
      });
    }
  };
  return trial;
}

}  // namespace hindsight
