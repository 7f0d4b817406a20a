#include "filters/mean_shift.h"

#include <Eigen/Cholesky>
#include <map>
#include <set>

#include "filters/tape_adjoint.h"
#include "filters/tape_gains.h"
#include "linear/small_product.h"
#include "linear/sparse_product.h"

namespace hindsight {
namespace {

double TimeOf(const LinearTape& tape, std::size_t k) {
  return tape.t(k) - tape.t(0);
}

/// The sum of the products in each row.
template <typename A, typename B>
Eigen::VectorXd RowSums(const Eigen::MatrixBase<A>& a,
                        const Eigen::MatrixBase<B>& b) {
  return a.cwiseProduct(b).rowwise().sum();
}

/// What belongs to the constants b of one group, n that stay and then, where they may,
/// the same n that grow with the time t: they enter by [B, t B]. Of Lambda no more
/// than the score of one constant, with or without its growth, takes.
class GroupScore {
 public:
  GroupScore(int dim, Eigen::Index count, bool may_grow)
      : count_(count),
        may_grow_(may_grow),
        lambda_(Eigen::VectorXd::Zero(2 * count)),
        bx_(Eigen::MatrixXd::Zero(may_grow ? 2 * count : count, dim)),
        stays_(Eigen::VectorXd::Zero(count)),
        both_(stays_),
        grows_(stays_) {}

  /// Before B moved the state.
  void Drive(const Eigen::MatrixXd& B, double t, const TapeAdjoint& state) {
    const Eigen::MatrixXd BL = B.transpose().lazyProduct(state.Lambda());
    AddLambda(B.transpose() * state.lambda(), t);
    const Eigen::VectorXd BLB = RowSums(BL, B.transpose());
    const Eigen::VectorXd XB = RowSums(staying(), B.transpose());
    if (may_grow_) {
      const Eigen::VectorXd TB = RowSums(growing(), B.transpose());
      both_ += t * XB + TB + t * BLB;
      grows_ += 2.0 * t * TB + t * t * BLB;
      growing() += t * BL;
    }
    stays_ += 2.0 * XB + BLB;
    staying() += BL;
  }

  void BackOver(const ErrorMatrix& Phi) { bx_ = Times(bx_, Phi); }

  /// Before a measurement that they do not enter.
  void BackBefore(const TapeMeasurement& z) {
    AddProduct<-1>(Reached(z.K), z.H, &bx_);
  }

  /// Before one that they enter by B: `ahead` is S^-1 nu - K' lambda of the state,
  /// `weight` S^-1 + K' Lambda K and LK = Lambda K.
  void BackBefore(const TapeMeasurement& z, const Eigen::MatrixXd& B, double t,
                  const RowVector& ahead, const RowMatrix& weight,
                  const GainMatrix& LK) {
    const Eigen::MatrixXd XK = Reached(z.K);
    const Eigen::MatrixXd BW = B.transpose().lazyProduct(weight);
    const Eigen::MatrixXd BKL = B.transpose().lazyProduct(LK.transpose());
    AddLambda(B.transpose() * ahead, t);
    if (may_grow_) {
      const Eigen::MatrixXd grows = t * BW - XK.bottomRows(count_);
      both_ += RowSums(grows - t * XK.topRows(count_), B.transpose());
      grows_ += t * RowSums(grows - XK.bottomRows(count_), B.transpose());
      auto growing = this->growing();
      AddProduct<1>(grows, z.H, &growing);
      growing -= t * BKL;
    }
    const Eigen::MatrixXd stays = BW - XK.topRows(count_);
    stays_ += RowSums(stays - XK.topRows(count_), B.transpose());
    auto staying = this->staying();
    AddProduct<1>(stays, z.H, &staying);
    staying -= BKL;
  }

  bool may_grow() const { return may_grow_; }
  Eigen::Index count() const { return count_; }
  double score(Eigen::Index i) const { return lambda_(i); }
  double information(Eigen::Index i) const { return stays_(i); }
  /// Of growth that begins at a time.
  double score_of_growth(Eigen::Index i, double onset) const {
    return lambda_(i + count_) - onset * lambda_(i);
  }
  double information_of_growth(Eigen::Index i, double onset) const {
    return grows_(i) - 2.0 * onset * both_(i) + onset * onset * stays_(i);
  }
  /// The largest term of that information.
  double largest_term(Eigen::Index i) const { return grows_(i); }

 private:
  /// Of Lambda K.
  template <typename Gain>
  Eigen::MatrixXd Reached(const Gain& K) const {
    Eigen::MatrixXd XK;
    Multiply(bx_, K, /*lower=*/false, &XK);
    return XK;
  }
  void AddLambda(const Eigen::VectorXd& added, double t) {
    lambda_.head(count_) += added;
    lambda_.tail(count_) += t * added;
  }
  Eigen::MatrixXd::RowsBlockXpr staying() { return bx_.topRows(count_); }
  Eigen::MatrixXd::RowsBlockXpr growing() { return bx_.bottomRows(count_); }

  Eigen::Index count_;
  bool may_grow_;
  Eigen::VectorXd lambda_;
  Eigen::MatrixXd bx_;  ///< of Lambda, rows of b and columns of the state
  /// Of Lambda, of a constant that stays, of the same that stays and grows, and of
  /// one that grows.
  Eigen::VectorXd stays_, both_, grows_;
};

class AdjointPass {
 public:
  AdjointPass(const LinearTape& tape, const ShiftColumns& columns)
      : tape_(tape), columns_(columns), state_(tape) {}

  Scores Run(std::span<const std::size_t> onsets,
             const EpochCallback& callback) {
    Scores found;
    std::size_t left = onsets.size();
    for (std::size_t k = tape_.size(); k-- > 0 && left > 0;) {
      if (callback) callback(tape_.size() - 1 - k);
      if (k + 1 < tape_.size()) BackOver(k + 1);
      const auto all = tape_.measurements(k);
      for (std::size_t i = all.size(); i-- > 0;) {
        if (all[i].accepted) BackBefore(k, all[i]);
      }
      if (onsets[left - 1] != k) continue;
      --left;
      Collect(k, left == 0, &found.shifts);
      if (left > 0) {
        found.states.push_back({k, state_.lambda(), state_.Lambda()});
      }
    }
    return found;
  }

 private:
  GroupScore& Of(const ShiftColumns::Columns& columns) {
    return groups_
        .try_emplace(columns.group, tape_.dim(), columns.B.cols(),
                     columns.may_grow)
        .first->second;
  }

  // All factors here are small or sparse, for which a general product is slow.

  /// Over the interval that ends at epoch k.
  void BackOver(std::size_t k) {
    if (columns_.driven) {
      const ShiftColumns::Columns driven = columns_.driven(k);
      Of(driven).Drive(driven.B, TimeOf(tape_, k), state_);
    }
    const ErrorMatrix Phi = tape_.Phi(k);
    state_.BackOver(Phi);
    for (auto& [group, own] : groups_) own.BackOver(Phi);
  }

  void BackBefore(std::size_t k, const TapeMeasurement& z) {
    const Eigen::LLT<RowMatrix> S(z.S);
    const RowVector ahead =
        S.solve(z.innovation) - z.K.transpose() * state_.lambda();
    GainMatrix LK;
    Multiply(state_.Lambda(), z.K, /*lower=*/false, &LK);
    RowMatrix weight = S.solve(RowMatrix::Identity(z.S.rows(), z.S.cols()));
    weight += z.K.transpose().lazyProduct(LK);
    std::set<ShiftColumns::Group> entered;
    for (const ShiftColumns::Columns& columns : columns_.measured(k, z)) {
      Of(columns).BackBefore(z, columns.B, TimeOf(tape_, k), ahead, weight, LK);
      entered.insert(columns.group);
    }
    for (auto& [group, own] : groups_) {
      if (!entered.contains(group)) own.BackBefore(z);
    }
    state_.BackBefore(z);
  }

  void Collect(std::size_t k, bool throughout,
               std::vector<MeanShift>* found) const {
    const auto add = [&](const MeanShift& shift) {
      if (shift.information > 0.0 && std::isfinite(shift.score)) {
        found->push_back(shift);
      }
    };
    if (!throughout) {
      for (int i = 0; i < tape_.dim(); ++i) {
        add({true, 0, i, false, k, state_.lambda()(i), state_.Lambda()(i, i)});
      }
    }
    const double t = TimeOf(tape_, k);
    for (const auto& [group, own] : groups_) {
      for (Eigen::Index i = 0; i < own.count(); ++i) {
        const auto column = static_cast<int>(i);
        add({false, group, column, false, k, own.score(i), own.information(i)});
        const double information = own.information_of_growth(i, t);
        // What is left of large terms may be their rounding.
        if (!own.may_grow() || information < 1e-9 * own.largest_term(i))
          continue;
        add({false, group, column, true, k, own.score_of_growth(i, t),
             information});
      }
    }
  }

  const LinearTape& tape_;
  const ShiftColumns& columns_;
  TapeAdjoint state_;
  std::map<ShiftColumns::Group, GroupScore> groups_;
};

}  // namespace

std::vector<std::size_t> SpreadOnsets(const LinearTape& tape, int count) {
  std::vector<std::size_t> onsets;
  const double begin = tape.t(0);
  const double step = (tape.back().t - begin) / count;
  double next = begin;
  for (std::size_t k = 0;
       k < tape.size() && onsets.size() < static_cast<std::size_t>(count);
       ++k) {
    if (tape.t(k) < next) continue;
    onsets.push_back(k);
    while (next <= tape.t(k) && step > 0.0) next += step;
  }
  return onsets;
}

Scores ScoreShifts(const LinearTape& tape, const ShiftColumns& columns,
                   std::span<const std::size_t> onsets,
                   const EpochCallback& callback) {
  RequireFixedNominal(tape);
  return AdjointPass(tape, columns).Run(onsets, callback);
}

}  // namespace hindsight
