#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "filters/shift_response.h"
#include "filters/tape_gains.h"
#include "linear/small_product.h"
#include "linear/sparse_product.h"

namespace hindsight {
namespace {

/// Of a correlation, below which an eigenvalue is rounding.
constexpr double kLeastWeight = 1e-6;

/// Scores and information of constants of one group, each from several onsets on.
/// With the error e of the estimates, a step theta from an onset on makes
///   e <- Phi e,  g = B theta - H e,  e <- e + K g
/// of it, g being what it adds to an innovation. Between two onsets all of this
/// is linear in (e, theta) at the first of them: what a span between onsets does
/// is found in one walk along the tape, and the spans are joined from the last.
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
        dim_(tape.dim()),
        count_(static_cast<Eigen::Index>(onsets.size())),
        width_(static_cast<Eigen::Index>(wanted.size())),
        score_(Eigen::VectorXd::Zero(count_ * width_)),
        information_(Eigen::MatrixXd::Zero(score_.size(), score_.size())) {}

  GroupEnergy Run() {
    const std::size_t end = LastMeasured() + 1;
    for (std::size_t k = onsets_.front(); k < end; ++k) {
      if (k > onsets_.front()) {
        const auto Phi = tape_.Phi(k);
        spans_.back().error = TimesTransposed(spans_.back().error, Phi);
      }
      while (spans_.size() < onsets_.size() && onsets_[spans_.size()] <= k) {
        spans_.push_back(EmptySpan());
      }
      for (const TapeMeasurement& z : tape_.measurements(k)) {
        if (z.accepted) Take(k, z);
      }
    }
    JoinSpans();
    return Energy();
  }

 private:
  /// From an onset to the next; rows are of e and theta at its begin.
  struct Span {
    Eigen::MatrixXd error;  ///< what they make of e at its end
    Eigen::VectorXd score;
    Eigen::MatrixXd information;  ///< its lower half, until spans are joined
  };

  Span EmptySpan() const {
    const Eigen::Index rows = dim_ + width_;
    return {Eigen::MatrixXd::Identity(rows, dim_), Eigen::VectorXd::Zero(rows),
            Eigen::MatrixXd::Zero(rows, rows)};
  }

  /// The last epoch with an accepted measurement, the first onset if none is
  /// later: what errors grow to behind it is in no innovation.
  std::size_t LastMeasured() const {
    std::size_t k = tape_.size() - 1;
    for (; k > onsets_.front(); --k) {
      const auto all = tape_.headers(k);
      if (std::any_of(all.begin(), all.end(),
                      [](const TapeMeasurement& z) { return z.accepted; })) {
        break;
      }
    }
    return k;
  }

  void Take(std::size_t k, const TapeMeasurement& z) {
    Span& span = spans_.back();
    Eigen::MatrixXd g = -TimesTransposed(span.error, z.H);
    if (z.sensor == group_) Enter(k, z, &g);
    const RowMatrix weight = Eigen::LLT<RowMatrix>(z.S).solve(
        RowMatrix::Identity(g.cols(), g.cols()));
    const Eigen::MatrixXd weighted = g.lazyProduct(weight);
    span.score += weighted * z.innovation;
    // Column by column: for a product with so few columns in between the blocks
    // of a general one do not pay.
    for (Eigen::Index c = 0; c < g.rows(); ++c) {
      const Eigen::Index below = g.rows() - c;
      span.information.col(c).tail(below) +=
          g.bottomRows(below).lazyProduct(weighted.row(c).transpose());
    }
    AddProduct<1>(g, z.K.transpose(), &span.error);
  }

  void Enter(std::size_t k, const TapeMeasurement& z,
             Eigen::MatrixXd* g) const {
    for (const ShiftColumns::Columns& one : columns_.measured(k, z)) {
      if (one.group != group_) continue;
      g->bottomRows(width_) +=
          one.B(Eigen::all, std::vector<int>(wanted_.begin(), wanted_.end()))
              .transpose();
    }
  }

  /// Has each span say what it and all behind it do together, and of that takes
  /// what is of steps: with e = 0 at the onset of the later of two.
  void JoinSpans() {
    for (std::size_t i = spans_.size(); i-- > 0;) {
      Span& span = spans_[i];
      span.information =
          Eigen::MatrixXd(span.information.selfadjointView<Eigen::Lower>());
      if (i + 1 < spans_.size()) {
        Eigen::MatrixXd T = Eigen::MatrixXd::Zero(dim_ + width_, dim_ + width_);
        T.leftCols(dim_) = span.error;
        T.bottomRightCorner(width_, width_).setIdentity();
        span.score += T * spans_[i + 1].score;
        span.information += T * spans_[i + 1].information * T.transpose();
      }
      score_.segment(static_cast<Eigen::Index>(i) * width_, width_) =
          span.score.tail(width_);
    }
    for (std::size_t first = 0; first < spans_.size(); ++first) {
      AddStepsFrom(first);
    }
  }

  /// The information of steps at an onset, and what they share with later ones.
  void AddStepsFrom(std::size_t first) {
    Eigen::MatrixXd e = Eigen::MatrixXd::Zero(width_, dim_);
    for (std::size_t i = first; i < spans_.size(); ++i) {
      const Span& span = spans_[i];
      information_.block(static_cast<Eigen::Index>(i) * width_,
                         static_cast<Eigen::Index>(first) * width_, width_,
                         width_) =
          span.information.bottomRightCorner(width_, width_) +
          span.information.bottomLeftCorner(width_, dim_) * e.transpose();
      e = (e * span.error.topRows(dim_) + span.error.bottomRows(width_)).eval();
    }
  }

  /// Over the onsets after which anything is measured.
  GroupEnergy Energy() const {
    GroupEnergy energy;
    energy.columns.resize(wanted_.size());
    energy.steps.setZero(count_, width_);
    std::vector<Eigen::Index> shown;
    for (Eigen::Index i = 0; i < score_.size(); ++i) {
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
  Eigen::Index dim_;    ///< of e
  Eigen::Index count_;  ///< onsets
  Eigen::Index width_;  ///< constants, of theta
  /// Of the onsets that have come before the last measurement.
  std::vector<Span> spans_;
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
