#include "problems/papers/lyapunov.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

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

class Analysis {
 public:
  Analysis(const LinearTape& tape, const ForwardModel& model,
           const Timeline& timeline, const std::vector<State>& truth)
      : tape_(tape),
        layout_(tape.layout()),
        error_(model.error),
        policy_(model.covariance, tape.layout()),
        timeline_(timeline),
        truth_(truth),
        scale_(layout_.InitialCovariance().diagonal().cwiseSqrt()) {}

  LyapunovFigures Run() {
    LyapunovFigures out;
    int falling = 0, falling_early = 0, early = 0;
    double before = 0.0;
    double next = 0.0;
    for (std::size_t k = 0; k < tape_.size(); ++k) {
      const TapeEpoch& epoch = tape_.epoch(k);
      const ErrorMatrix P = tape_.P_plus(k);
      const ErrorVector e = Local(error_, layout_, epoch.x_plus, truth_[k]);
      const double V = e.dot(P.llt().solve(e));
      out.v_largest = std::max(out.v_largest, V);
      if (k > 0) {
        const bool in_early = epoch.t - tape_.epoch(0).t <= kEarly;
        falling += V < before ? 1 : 0;
        early += in_early ? 1 : 0;
        falling_early += in_early && V < before ? 1 : 0;
      } else {
        out.v_first = V;
      }
      before = V;
      if (k == 0 || epoch.t < next) continue;
      next = epoch.t + kEvery - 1e-6;
      Bounds(P, &out);
      const double radius = Radius(k, P);
      if (out.radius_first == 0.0) out.radius_first = radius;
      out.radius_largest = std::max(out.radius_largest, radius);
    }
    out.v_last = before;
    out.share_falling =
        falling / std::max(1.0, static_cast<double>(tape_.size()) - 1.0);
    out.share_falling_early = falling_early / std::max(1.0, 1.0 * early);
    return out;
  }

 private:
  void Bounds(const ErrorMatrix& P, LyapunovFigures* out) const {
    const ErrorVector s = scale_.cwiseInverse();
    const Eigen::VectorXd values =
        Eigenvalues(s.asDiagonal() * P * s.asDiagonal());
    const double least = values.minCoeff();
    out->p_least = out->p_least == 0.0 ? least : std::min(out->p_least, least);
    out->p_largest = std::max(out->p_largest, values.maxCoeff());
  }

  /// mu: P^1/2 M P^1/2 with the Cholesky factor of P for its root.
  double DecayRate(std::size_t k, const ErrorMatrix& P, double dt) const {
    const ErrorMatrix root = P.llt().matrixL();
    const ErrorMatrix inverse = root.triangularView<Eigen::Lower>().solve(
        ErrorMatrix::Identity(P.rows(), P.rows()));
    ErrorMatrix M = inverse * (tape_.Q(k) / dt) * inverse.transpose();
    ErrorMatrix information = policy_.WeightMatrix();
    for (const TapeMeasurement& z : tape_.measurements(k)) {
      if (!z.accepted) continue;
      const Eigen::MatrixXd R = z.R;
      information += z.H.transpose() * R.llt().solve(z.H) / dt;
    }
    M += root.transpose() * information * root;
    if (policy_.alpha().size() > 0) {
      const ErrorMatrix S =
          root.transpose() * policy_.alpha().asDiagonal() * inverse.transpose();
      M += S + S.transpose();
    }
    const double mu = Eigenvalues(M).minCoeff();
    return mu > kLeastRate ? mu : 0.0;
  }

  double Radius(std::size_t k, const ErrorMatrix& P) const {
    const double dt = tape_.epoch(k).t - tape_.epoch(k - 1).t;
    const ErrorMatrix information =
        P.llt().solve(ErrorMatrix::Identity(P.rows(), P.rows()));
    const auto largest = [&](const ErrorMatrix& M, BlockKind kind) {
      return LargestOf(layout_, M, kind);
    };
    const double psi = largest(P, BlockKind::kAttitude);
    const double gyro = largest(P, BlockKind::kGyroBias);
    const double accel = largest(P, BlockKind::kAccelBias);
    const double on_v = std::sqrt(largest(information, BlockKind::kVelocity));
    const double on_psi = std::sqrt(largest(information, BlockKind::kAttitude));
    const double f = timeline_.node(k).kinematics.f_b.norm();
    double c = on_v * std::sqrt(psi * accel) + on_psi * std::sqrt(psi * gyro);
    if (error_ == ErrorDefinition::kLeftInvariant) {
      c += on_v * std::sqrt(largest(P, BlockKind::kVelocity) * gyro);
    } else {
      c += on_v * 0.5 * f * psi;
    }
    return DecayRate(k, P, dt) / (2.0 * c) / on_psi;
  }

  const LinearTape& tape_;
  const ErrorLayout& layout_;
  ErrorDefinition error_;
  CovariancePolicy policy_;
  const Timeline& timeline_;
  const std::vector<State>& truth_;
  ErrorVector scale_;
};

}  // namespace

LyapunovFigures AnalyseRun(const LinearTape& tape, const ForwardModel& model,
                           const Timeline& timeline,
                           const std::vector<State>& truth) {
  return Analysis(tape, model, timeline, truth).Run();
}

}  // namespace hindsight
