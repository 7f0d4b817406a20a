#include "filters/shift_response.h"

#include <Eigen/Cholesky>

#include "filters/tape_gains.h"

namespace hindsight {
namespace {

/// How large a deviation is at epoch k, of the size of one.
double SizeAt(const MeanShift& shift, const LinearTape& tape, std::size_t k) {
  if (k < shift.onset) return 0.0;
  if (!shift.grows) return 1.0;
  return tape.epoch(k).t - tape.epoch(shift.onset).t;
}

/// What it adds to a measurement.
Eigen::VectorXd AddedTo(const TapeMeasurement& z, const MeanShift& shift,
                        const LinearTape& tape, std::size_t k,
                        const ShiftColumns& columns) {
  Eigen::VectorXd added = Eigen::VectorXd::Zero(z.H.rows());
  const double size = SizeAt(shift, tape, k);
  if (shift.of_state || size == 0.0) return added;
  for (const ShiftColumns::Columns& one : columns.measured(k, z)) {
    if (one.group == shift.group) added = size * one.B.col(shift.column);
  }
  return added;
}

/// What it adds to the true state by epoch k.
ErrorVector AddedTo(std::size_t k, const MeanShift& shift,
                    const LinearTape& tape, const ShiftColumns& columns) {
  ErrorVector added = ErrorVector::Zero(tape.dim());
  if (shift.of_state) {
    if (k == shift.onset) added(shift.column) = 1.0;
  } else if (k > shift.onset && columns.driven) {
    const ShiftColumns::Columns driven = columns.driven(k);
    if (driven.group == shift.group) {
      added = SizeAt(shift, tape, k) * driven.B.col(shift.column);
    }
  }
  return added;
}

/// What a deviation of the size of one does to the filter.
struct Response {
  std::vector<ErrorVector> truth;        ///< by what the true states differ
  std::vector<ErrorVector> minus, plus;  ///< by what the estimates do
};

Response Filtered(const MeanShift& shift, const LinearTape& tape,
                  const ShiftColumns& columns) {
  Response out;
  ErrorVector truth = ErrorVector::Zero(tape.dim());
  ErrorVector e = truth;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    if (k > 0) {
      truth = tape.Phi(k) * truth;
      e = tape.Phi(k) * e;
    }
    truth += AddedTo(k, shift, tape, columns);
    out.minus.push_back(e);
    const std::vector<Eigen::MatrixXd> gains = GainsAt(tape, k);
    const auto all = tape.measurements(k);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!all[i].accepted) continue;
      e += gains[i] *
           (all[i].H * (truth - e) + AddedTo(all[i], shift, tape, k, columns));
    }
    out.plus.push_back(e);
    out.truth.push_back(truth);
  }
  return out;
}

}  // namespace

std::vector<ErrorVector> CorrectionFor(const MeanShift& shift,
                                       const LinearTape& tape,
                                       const ShiftColumns& columns) {
  RequireFixedNominal(tape);
  const Response response = Filtered(shift, tape, columns);
  std::vector<ErrorVector> correction(tape.size());
  ErrorVector e = response.plus.back();
  for (std::size_t k = tape.size(); k-- > 0;) {
    if (k + 1 < tape.size()) {
      e = response.plus[k] + Smoothed(tape, k, e - response.minus[k + 1]);
    }
    correction[k] = response.truth[k] - e;
  }
  return correction;
}

namespace {

/// Carries what constants of one group, each from several onsets on, do to the
/// estimates: a block of columns a constant, a column of it an onset.
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
        e_(Eigen::MatrixXd::Zero(
            tape.dim(), count_ * static_cast<Eigen::Index>(wanted.size()))),
        score_(Eigen::VectorXd::Zero(e_.cols())),
        information_(wanted.size(), Eigen::MatrixXd::Zero(count_, count_)) {}

  std::vector<ShiftEnergy> Run() {
    for (std::size_t k = onsets_.front(); k < tape_.size(); ++k) {
      while (begun_ < count_ &&
             onsets_[static_cast<std::size_t>(begun_)] <= k) {
        ++begun_;
      }
      if (k > onsets_.front()) e_ = tape_.Phi(k) * e_;
      const std::vector<Eigen::MatrixXd> gains = GainsAt(tape_, k);
      const auto all = tape_.measurements(k);
      for (std::size_t i = 0; i < all.size(); ++i) {
        if (all[i].accepted) Take(k, all[i], gains[i]);
      }
    }
    std::vector<ShiftEnergy> energies;
    for (std::size_t w = 0; w < wanted_.size(); ++w) energies.push_back(Sum(w));
    return energies;
  }

 private:
  void Take(std::size_t k, const TapeMeasurement& z, const Eigen::MatrixXd& K) {
    Eigen::MatrixXd g = -(z.H * e_);
    if (z.sensor == group_) Enter(k, z, &g);
    const Eigen::LLT<Eigen::MatrixXd> S(z.S);
    const Eigen::MatrixXd weighted = S.solve(g);
    score_ += weighted.transpose() * z.innovation;
    for (std::size_t w = 0; w < wanted_.size(); ++w) {
      const Eigen::Index at = static_cast<Eigen::Index>(w) * count_;
      information_[w].topLeftCorner(begun_, begun_) +=
          g.middleCols(at, begun_).transpose() *
          weighted.middleCols(at, begun_);
    }
    e_ += K * g;
  }

  void Enter(std::size_t k, const TapeMeasurement& z, Eigen::MatrixXd* g) {
    for (const ShiftColumns::Columns& one : columns_.measured(k, z)) {
      if (one.group != group_) continue;
      for (std::size_t w = 0; w < wanted_.size(); ++w) {
        g->middleCols(static_cast<Eigen::Index>(w) * count_, begun_)
            .colwise() += one.B.col(wanted_[w]);
      }
    }
  }

  /// Over the onsets after which anything is measured.
  ShiftEnergy Sum(std::size_t w) const {
    const Eigen::MatrixXd& all = information_[w];
    Eigen::Index last = 0;
    while (last < count_ && all(last, last) > 0.0) ++last;
    if (last == 0) return {};
    const Eigen::VectorXd sigma = all.diagonal().head(last).cwiseSqrt();
    const Eigen::MatrixXd correlation = sigma.cwiseInverse().asDiagonal() *
                                        all.topLeftCorner(last, last) *
                                        sigma.cwiseInverse().asDiagonal();
    const double trace = correlation.trace();
    const double squares = correlation.squaredNorm();
    const auto own =
        score_.segment(static_cast<Eigen::Index>(w) * count_, last);
    return {own.cwiseQuotient(sigma).squaredNorm(), squares / trace,
            trace * trace / squares};
  }

  ShiftColumns::Group group_;
  std::span<const int> wanted_;
  std::span<const std::size_t> onsets_;
  const LinearTape& tape_;
  const ShiftColumns& columns_;
  Eigen::Index count_;
  Eigen::Index begun_ = 0;  ///< onsets that have come
  Eigen::MatrixXd e_;       ///< by what the estimates differ
  Eigen::VectorXd score_;
  std::vector<Eigen::MatrixXd> information_;
};

}  // namespace

std::vector<ShiftEnergy> EnergiesOf(ShiftColumns::Group group,
                                    std::span<const int> wanted,
                                    std::span<const std::size_t> onsets,
                                    const LinearTape& tape,
                                    const ShiftColumns& columns) {
  RequireFixedNominal(tape);
  return OnsetPass(group, wanted, onsets, tape, columns).Run();
}

}  // namespace hindsight
