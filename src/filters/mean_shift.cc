#include "filters/mean_shift.h"

#include <Eigen/Cholesky>
#include <map>
#include <set>

#include "filters/tape_adjoint.h"
#include "filters/tape_gains.h"
#include "linear/sparse_product.h"

namespace hindsight {
namespace {

/// Columns beside the same times t.
Eigen::MatrixXd WithGrowth(const Eigen::MatrixXd& B, double t) {
  Eigen::MatrixXd both(B.rows(), 2 * B.cols());
  both << B, t * B;
  return both;
}

double TimeOf(const LinearTape& tape, std::size_t k) {
  return tape.t(k) - tape.t(0);
}

/// What belongs to the constants b of one group.
struct GroupScore {
  GroupScore(int dim, Eigen::Index count)
      : lambda(Eigen::VectorXd::Zero(count)),
        bx(Eigen::MatrixXd::Zero(count, dim)),
        bb(Eigen::MatrixXd::Zero(count, count)) {}

  /// Before what moved the state by B b of the constants that stay and t B b of
  /// those that grow: of G = [B, t B],
  ///   lambda += G' lambda_x,   bb += bx G + (bx G)' + G' Lambda G,
  ///   bx += G' Lambda.
  void Drive(const Eigen::MatrixXd& B, double t, const TapeAdjoint& state) {
    const Eigen::Index n = B.cols();
    const Eigen::MatrixXd LB = state.Lambda().lazyProduct(B);
    const Eigen::MatrixXd XB = bx.lazyProduct(B);
    const Eigen::MatrixXd BLB = B.transpose().lazyProduct(LB);
    const Eigen::VectorXd Bl = B.transpose() * state.lambda();
    lambda.head(n) += Bl;
    lambda.tail(n) += t * Bl;
    bb.leftCols(n) += XB;
    bb.rightCols(n) += t * XB;
    bb.topRows(n) += XB.transpose();
    bb.bottomRows(n) += t * XB.transpose();
    bb.topLeftCorner(n, n) += BLB;
    bb.topRightCorner(n, n) += t * BLB;
    bb.bottomLeftCorner(n, n) += t * BLB;
    bb.bottomRightCorner(n, n) += t * t * BLB;
    bx.topRows(n) += LB.transpose();
    bx.bottomRows(n) += t * LB.transpose();
  }

  Eigen::VectorXd lambda;
  Eigen::MatrixXd bx, bb;  ///< blocks of Lambda, rows of b
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
  GroupScore& Of(ShiftColumns::Group group, Eigen::Index count) {
    return groups_.try_emplace(group, tape_.dim(), count).first->second;
  }

  // All factors here are small or sparse, for which a general product is slow.

  /// Over the interval that ends at epoch k.
  void BackOver(std::size_t k) {
    if (columns_.driven) {
      const ShiftColumns::Columns driven = columns_.driven(k);
      Of(driven.group, 2 * driven.B.cols())
          .Drive(driven.B, TimeOf(tape_, k), state_);
    }
    const ErrorMatrix Phi = tape_.Phi(k);
    state_.BackOver(Phi);
    for (auto& [group, own] : groups_) own.bx = Times(own.bx, Phi);
  }

  void BackBefore(std::size_t k, const TapeMeasurement& z) {
    const Eigen::LLT<RowMatrix> S(z.S);
    const RowVector ahead =
        S.solve(z.innovation) - z.K.transpose() * state_.lambda();
    const GainMatrix LK = state_.Lambda().lazyProduct(z.K);
    const RowMatrix KLK = z.K.transpose().lazyProduct(LK);
    std::set<ShiftColumns::Group> entered;
    for (const ShiftColumns::Columns& columns : columns_.measured(k, z)) {
      const Eigen::MatrixXd B = WithGrowth(columns.B, TimeOf(tape_, k));
      GroupScore& own = Of(columns.group, B.cols());
      const Eigen::MatrixXd XK = own.bx.lazyProduct(z.K);
      Eigen::MatrixXd direct = S.solve(B) - XK.transpose();
      direct += KLK.lazyProduct(B);
      own.lambda += B.transpose() * ahead;
      own.bb += B.transpose().lazyProduct(direct);
      own.bb -= XK.lazyProduct(B);
      own.bx += direct.transpose().lazyProduct(z.H);
      own.bx -= B.transpose().lazyProduct(LK.transpose());
      entered.insert(columns.group);
    }
    for (auto& [group, own] : groups_) {
      if (entered.contains(group)) continue;
      const Eigen::MatrixXd XK = own.bx.lazyProduct(z.K);
      own.bx -= XK.lazyProduct(z.H);
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
      const auto count = static_cast<int>(own.lambda.size() / 2);
      for (int i = 0; i < count; ++i) {
        const int j = i + count;
        add({false, group, i, false, k, own.lambda(i), own.bb(i, i)});
        const double information =
            own.bb(j, j) - 2.0 * t * own.bb(i, j) + t * t * own.bb(i, i);
        // What is left of large terms may be their rounding.
        if (information < 1e-9 * own.bb(j, j)) continue;
        add({false, group, i, true, k, own.lambda(j) - t * own.lambda(i),
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

Scores ScoreShifts(const LinearTape& tape, const ShiftColumns& columns,
                   std::span<const std::size_t> onsets,
                   const EpochCallback& callback) {
  RequireFixedNominal(tape);
  return AdjointPass(tape, columns).Run(onsets, callback);
}

}  // namespace hindsight
