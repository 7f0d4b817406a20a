#include "filters/side_agreement.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace hindsight {
namespace {

using Solver = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;

/// Eigenvalues of a scaled covariance from `least` to `most` mean something.
struct Range {
  double least, most;
};

/// Fills distance and dof from d ~ N(0, C).
void Measure(const Eigen::VectorXd& d, const Eigen::MatrixXd& C,
             const Range& range, SideAgreement* out) {
  const Solver solver(C);
  double squares = 0.0;
  for (Eigen::Index i = 0; i < d.size(); ++i) {
    const double variance = solver.eigenvalues()(i);
    if (!(variance > range.least && variance < range.most)) continue;
    const double along = solver.eigenvectors().col(i).dot(d);
    squares += along * along / variance;
    ++out->dof;
  }
  out->distance = std::sqrt(squares);
}

/// Lambda^-1, where what nothing is known of has a large variance.
Eigen::MatrixXd InverseOf(const Eigen::MatrixXd& Lambda) {
  constexpr double kLeast = 1e-12;
  const Solver solver(Lambda);
  return solver.eigenvectors() *
         solver.eigenvalues().cwiseMax(kLeast).cwiseInverse().asDiagonal() *
         solver.eigenvectors().transpose();
}

}  // namespace

std::vector<SideAgreement> AgreementOfSides(
    const LinearTape& tape, std::span<const StateScore> scores) {
  // In forward standard deviations: 1e4 of them on the other side are nothing
  // known; a hundredth of one, in the difference to the smoother, is rounding.
  constexpr Range kSides{0.0, 1e8};
  constexpr Range kSmoothed{1e-4, 1e8};
  std::vector<SideAgreement> all;
  for (const StateScore& score : scores) {
    const ErrorMatrix P = tape.P_minus(score.epoch);
    const Eigen::VectorXd scale = P.diagonal().cwiseSqrt();
    if (!(scale.array() > 0.0).all()) continue;
    const Eigen::MatrixXd Lambda =
        scale.asDiagonal() * score.Lambda * scale.asDiagonal();
    const Eigen::VectorXd lambda = scale.cwiseProduct(score.lambda);
    const Eigen::MatrixXd correlation = scale.cwiseInverse().asDiagonal() * P *
                                        scale.cwiseInverse().asDiagonal();
    const Eigen::MatrixXd apart = InverseOf(Lambda);
    const Eigen::VectorXd difference = apart * lambda;
    const Eigen::MatrixXd gained = correlation * Lambda * correlation;
    const Eigen::VectorXd step = correlation * lambda;
    for (const BlockKind kind :
         {BlockKind::kPosition, BlockKind::kVelocity, BlockKind::kAttitude}) {
      const Block* block = tape.layout().Find(kind);
      if (block == nullptr || block->dim == 0) continue;
      const auto at = Eigen::seqN(block->offset, block->dim);
      SideAgreement sides{.of = SideAgreement::Of::kForwardAndBackward,
                          .block = kind,
                          .epoch = score.epoch};
      SideAgreement smoothed{.of = SideAgreement::Of::kFilterAndSmoother,
                             .block = kind,
                             .epoch = score.epoch};
      Measure(difference(at), apart(at, at), kSides, &sides);
      Measure(step(at), gained(at, at), kSmoothed, &smoothed);
      if (sides.dof > 0) all.push_back(sides);
      if (smoothed.dof > 0) all.push_back(smoothed);
    }
  }
  return all;
}

}  // namespace hindsight
