#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "filters/shift_response.h"
#include "filters/tape_gains.h"
#include "linear/sparse_product.h"

namespace hindsight {
namespace {

/// Of a correlation, below which an eigenvalue is rounding.
constexpr double kLeastWeight = 1e-6;

/// Carries what constants of one group, each from several onsets on, do to the
/// estimates: a block of rows an onset, a row of it a constant, so that those
/// of the onsets that have come are the first.
class OnsetPass {
 public:
  OnsetPass(ShiftColumns::Group group, std::span<const int> wanted,
            std::span<const std::size_t> onsets, const LinearTape& tape,
            const ShiftColumns& columns)
      : group_(group),
        wanted_(wanted),
        onsets_(onsets),
        tape_(tape),
        columns_(columns),
        count_(static_cast<Eigen::Index>(onsets.size())),
        width_(static_cast<Eigen::Index>(wanted.size())),
        e_(Eigen::MatrixXd::Zero(count_ * width_, tape.dim())),
        score_(Eigen::VectorXd::Zero(e_.rows())),
        information_(Eigen::MatrixXd::Zero(e_.rows(), e_.rows())) {}

  GroupEnergy Run() {
    for (std::size_t k = onsets_.front(); k < tape_.size(); ++k) {
      while (begun_ < count_ &&
             onsets_[static_cast<std::size_t>(begun_)] <= k) {
        ++begun_;
      }
      if (k > onsets_.front()) begun() = TimesTransposed(begun(), tape_.Phi(k));
      for (const TapeMeasurement& z : tape_.measurements(k)) {
        if (z.accepted) Take(k, z);
      }
    }
    return Energy();
  }

 private:
  /// The rows of the onsets that have come; of the others all is zero.
  Eigen::MatrixXd::RowsBlockXpr begun() { return e_.topRows(begun_ * width_); }

  void Take(std::size_t k, const TapeMeasurement& z) {
    Eigen::MatrixXd g = -TimesTransposed(begun(), z.H);
    if (z.sensor == group_) Enter(k, z, &g);
    const RowMatrix weight = Eigen::LLT<RowMatrix>(z.S).solve(
        RowMatrix::Identity(g.cols(), g.cols()));
    const Eigen::MatrixXd weighted = g.lazyProduct(weight);
    score_.head(g.rows()) += weighted * z.innovation;
    // Column by column: for a product with so few columns in between the blocks
    // of a general one do not pay.
    for (Eigen::Index c = 0; c < g.rows(); ++c) {
      const Eigen::Index below = g.rows() - c;
      information_.col(c).segment(c, below) +=
          g.bottomRows(below).lazyProduct(weighted.row(c).transpose());
    }
    begun() += g.lazyProduct(z.K.transpose());
  }

  void Enter(std::size_t k, const TapeMeasurement& z, Eigen::MatrixXd* g) {
    for (const ShiftColumns::Columns& one : columns_.measured(k, z)) {
      if (one.group != group_) continue;
      for (Eigen::Index c = 0; c < g->rows(); ++c) {
        g->row(c) += one.B.col(wanted_[static_cast<std::size_t>(c % width_)])
                         .transpose();
      }
    }
  }

  /// Over the onsets after which anything is measured.
  GroupEnergy Energy() const {
    GroupEnergy energy;
    energy.columns.resize(wanted_.size());
    energy.steps.setZero(count_, width_);
    std::vector<Eigen::Index> shown;
    for (Eigen::Index i = 0; i < e_.rows(); ++i) {
      if (information_(i, i) > 0.0) shown.push_back(i);
    }
    if (shown.empty()) return energy;
    const Eigen::MatrixXd all = information_.selfadjointView<Eigen::Lower>();
    const Eigen::MatrixXd G = all(shown, shown);
    const Eigen::VectorXd score = score_(shown);
    const Eigen::VectorXd sigma = G.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::VectorXd z = score.cwiseProduct(sigma);
    const Eigen::MatrixXd C = sigma.asDiagonal() * G * sigma.asDiagonal();
    for (std::size_t w = 0; w < wanted_.size(); ++w) {
      std::vector<Eigen::Index> own;
      for (std::size_t i = 0; i < shown.size(); ++i) {
        if (shown[i] % width_ == static_cast<Eigen::Index>(w)) {
          own.push_back(static_cast<Eigen::Index>(i));
        }
      }
      if (own.empty()) continue;
      energy.columns[w].sum = z(own).squaredNorm();
      const Eigen::VectorXd weights =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(C(own, own),
                                                         Eigen::EigenvaluesOnly)
              .eigenvalues();
      energy.columns[w].weights.assign(weights.begin(), weights.end());
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(C);
    const Eigen::VectorXd along = eigen.eigenvectors().transpose() * z;
    const double largest = eigen.eigenvalues().maxCoeff();
    for (Eigen::Index i = 0; i < along.size(); ++i) {
      const double weight = eigen.eigenvalues()(i);
      if (!(weight > kLeastWeight * largest)) continue;
      energy.whitened += along(i) * along(i) / weight;
      energy.dof += 1.0;
    }
    const Eigen::VectorXd steps = Steps(shown, G, score, energy);
    for (std::size_t i = 0; i < shown.size(); ++i) {
      energy.steps(shown[i] / width_, shown[i] % width_) =
          steps(static_cast<Eigen::Index>(i));
    }
    return energy;
  }

  Eigen::VectorXd Steps(const std::vector<Eigen::Index>& shown,
                        const Eigen::MatrixXd& G, const Eigen::VectorXd& score,
                        const GroupEnergy& energy) const {
    Eigen::VectorXd unit(score.size());
    for (Eigen::Index i = 0; i < unit.size(); ++i) {
      const Eigen::Index first = shown[static_cast<std::size_t>(i)] % width_;
      unit(i) = information_(first, first) > 0.0
                    ? 1.0 / std::sqrt(information_(first, first))
                    : 0.0;
    }
    const Eigen::MatrixXd G_unit = unit.asDiagonal() * G * unit.asDiagonal();
    const Eigen::VectorXd s_unit = unit.cwiseProduct(score);
    double sum = 0.0;
    for (const ShiftEnergy& one : energy.columns) sum += one.sum;
    const double variance =
        std::max((sum - static_cast<double>(score.size())) /
                     G_unit.cwiseAbs2()
                         .rowwise()
                         .sum()
                         .cwiseQuotient(G_unit.diagonal())
                         .sum(),
                 (energy.whitened - energy.dof) / G_unit.trace());
    if (!(variance > 0.0)) return Eigen::VectorXd::Zero(score.size());
    Eigen::MatrixXd posterior = G_unit;
    posterior.diagonal().array() += 1.0 / variance;
    return unit.cwiseProduct(posterior.llt().solve(s_unit));
  }

  ShiftColumns::Group group_;
  std::span<const int> wanted_;
  std::span<const std::size_t> onsets_;
  const LinearTape& tape_;
  const ShiftColumns& columns_;
  Eigen::Index count_;
  Eigen::Index width_;      ///< constants
  Eigen::Index begun_ = 0;  ///< onsets that have come
  Eigen::MatrixXd e_;       ///< by what the estimates differ
  Eigen::VectorXd score_;
  Eigen::MatrixXd information_;
};

}  // namespace

GroupEnergy EnergiesOf(ShiftColumns::Group group, std::span<const int> wanted,
                       std::span<const std::size_t> onsets,
                       const LinearTape& tape, const ShiftColumns& columns) {
  RequireFixedNominal(tape);
  return OnsetPass(group, wanted, onsets, tape, columns).Run();
}

}  // namespace hindsight
