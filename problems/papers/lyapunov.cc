#include "problems/papers/lyapunov.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "evaluation/statistics.h"

namespace hindsight {
namespace {

constexpr double kEarly = 30.0;
constexpr double kEvery = 1.0;
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
double ShareFalling(std::span<const double> values) {
  double falling = 0.0;
  for (std::size_t k = 1; k < values.size(); ++k) {
    if (values[k] < values[k - 1]) falling += 1.0;
  }
  return falling / std::max(1.0, static_cast<double>(values.size()) - 1.0);
}

struct Analysis {
  const LinearTape& tape;
  const ErrorLayout& layout;
  ErrorDefinition error;
  CovariancePolicy policy;
  const Timeline& timeline;
  const std::vector<State>& truth;
  ErrorVector scale;  ///< a priori standard deviations

  RunValues Run() const {
    std::vector<double> V, values, radii;
    std::size_t early = 0;
    double next = 0.0;
    for (std::size_t k = 0; k < tape.size(); ++k) {
      const TapeEpoch& epoch = tape.epoch(k);
      const ErrorMatrix P = tape.P_plus(k);
      const ErrorVector e = Local(error, layout, epoch.x_plus, truth[k]);
      V.push_back(e.dot(P.llt().solve(e)));
      if (epoch.t - tape.epoch(0).t <= kEarly) ++early;
      if (k == 0 || epoch.t < next) continue;
      next = epoch.t + kEvery - 1e-6;
      const ErrorVector s = scale.cwiseInverse();
      std::ranges::copy(Eigenvalues(s.asDiagonal() * P * s.asDiagonal()),
                        std::back_inserter(values));
      radii.push_back(Radius(k, P));
    }
    const auto guaranteed = std::ranges::find_if(
        radii, [](double radius) { return radius != 0.0; });
    return {{"v_first", V.front()},
            {"v_last", V.back()},
            {"v_largest", Largest(V)},
            {"share_falling", ShareFalling(V)},
            {"share_falling_early", ShareFalling(std::span(V).first(early))},
            {"p_least", Least(values)},
            {"p_largest", Largest(values)},
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
    const double dt = tape.epoch(k).t - tape.epoch(k - 1).t;
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

RunValues AnalyseRun(const LinearTape& tape, const ForwardModel& model,
                     const Timeline& timeline,
                     const std::vector<State>& truth) {
  const ErrorLayout& layout = tape.layout();
  return Analysis{tape,
                  layout,
                  model.error,
                  {model.covariance, layout},
                  timeline,
                  truth,
                  layout.InitialCovariance().diagonal().cwiseSqrt()}
      .Run();
}

}  // namespace hindsight
