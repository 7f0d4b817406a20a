#include "filters/shift_response.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "filters/tape_gains.h"

namespace hindsight {
namespace {

/// A deviation as large as `sizes` says at each epoch, or a jump of the state.
struct Course {
  bool of_state = false;
  std::size_t onset = 0;  ///< of a jump
  ShiftColumns::Group group = 0;
  int column = 0;
  std::vector<double> sizes = {};
};

/// What it adds to a measurement of epoch k.
Eigen::VectorXd AddedTo(const TapeMeasurement& z, const Course& course,
                        std::size_t k, const ShiftColumns& columns) {
  Eigen::VectorXd added = Eigen::VectorXd::Zero(z.H.rows());
  if (course.of_state || course.sizes[k] == 0.0) return added;
  for (const ShiftColumns::Columns& one : columns.measured(k, z)) {
    if (one.group == course.group) {
      added = course.sizes[k] * one.B.col(course.column);
    }
  }
  return added;
}

/// What it adds to the true state by epoch k.
ErrorVector AddedTo(std::size_t k, const Course& course, const LinearTape& tape,
                    const ShiftColumns& columns) {
  ErrorVector added = ErrorVector::Zero(tape.dim());
  if (course.of_state) {
    if (k == course.onset) added(course.column) = 1.0;
  } else if (k > course.onset && columns.driven) {
    const ShiftColumns::Columns driven = columns.driven(k);
    if (driven.group == course.group) {
      added = course.sizes[k] * driven.B.col(course.column);
    }
  }
  return added;
}

/// What it does to the filter.
struct Response {
  std::vector<ErrorVector> truth;        ///< by what the true states differ
  std::vector<ErrorVector> minus, plus;  ///< by what the estimates do
};

Response Filtered(const Course& course, const LinearTape& tape,
                  const ShiftColumns& columns) {
  Response out;
  ErrorVector truth = ErrorVector::Zero(tape.dim());
  ErrorVector e = truth;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    if (k > 0) {
      truth = tape.Phi(k) * truth;
      e = tape.Phi(k) * e;
    }
    truth += AddedTo(k, course, tape, columns);
    out.minus.push_back(e);
    const std::vector<Eigen::MatrixXd> gains = GainsAt(tape, k);
    const auto all = tape.measurements(k);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!all[i].accepted) continue;
      e += gains[i] *
           (all[i].H * (truth - e) + AddedTo(all[i], course, k, columns));
    }
    out.plus.push_back(e);
    out.truth.push_back(truth);
  }
  return out;
}

std::vector<ErrorVector> CorrectionForCourse(const Course& course,
                                             const LinearTape& tape,
                                             const ShiftColumns& columns) {
  RequireFixedNominal(tape);
  const Response response = Filtered(course, tape, columns);
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

}  // namespace

std::vector<ErrorVector> CorrectionFor(const MeanShift& shift,
                                       const LinearTape& tape,
                                       const ShiftColumns& columns) {
  Course course{.of_state = shift.of_state,
                .onset = shift.onset,
                .group = shift.group,
                .column = shift.column};
  if (!shift.of_state) {
    course.sizes.resize(tape.size());
    for (std::size_t k = shift.onset; k < tape.size(); ++k) {
      course.sizes[k] =
          shift.grows ? tape.epoch(k).t - tape.epoch(shift.onset).t : 1.0;
    }
  }
  return CorrectionForCourse(course, tape, columns);
}

std::vector<ErrorVector> CorrectionForSteps(ShiftColumns::Group group,
                                            int column,
                                            std::span<const std::size_t> onsets,
                                            std::span<const double> steps,
                                            const LinearTape& tape,
                                            const ShiftColumns& columns) {
  Course course{.onset = onsets.front(), .group = group, .column = column};
  course.sizes.resize(tape.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    for (std::size_t k = onsets[i]; k < tape.size(); ++k) {
      course.sizes[k] += steps[i];
    }
  }
  return CorrectionForCourse(course, tape, columns);
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

  std::vector<ShiftEnergy> Run(const EpochCallback& callback) {
    for (std::size_t k = onsets_.front(); k < tape_.size(); ++k) {
      if (callback) callback(k);
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
    const Eigen::VectorXd own =
        score_.segment(static_cast<Eigen::Index>(w) * count_, last);
    ShiftEnergy energy;
    energy.sum = own.cwiseQuotient(sigma).squaredNorm();
    const Eigen::VectorXd weights =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(correlation,
                                                       Eigen::EigenvaluesOnly)
            .eigenvalues();
    energy.weights.assign(weights.begin(), weights.end());
    const Eigen::VectorXd steps = Steps(all.topLeftCorner(last, last), own);
    energy.steps.assign(steps.begin(), steps.end());
    return energy;
  }

  static Eigen::VectorXd Steps(const Eigen::MatrixXd& G,
                               const Eigen::VectorXd& score) {
    const Eigen::VectorXd D = G.diagonal();
    const double more = score.cwiseAbs2().cwiseQuotient(D).sum() -
                        static_cast<double>(score.size());
    if (!(more > 0.0)) return Eigen::VectorXd::Zero(score.size());
    const double variance =
        more / (G.cwiseAbs2().rowwise().sum().cwiseQuotient(D)).sum();
    Eigen::MatrixXd posterior = G;
    posterior.diagonal().array() += 1.0 / variance;
    return posterior.llt().solve(score);
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
                                    const ShiftColumns& columns,
                                    const EpochCallback& callback) {
  RequireFixedNominal(tape);
  return OnsetPass(group, wanted, onsets, tape, columns).Run(callback);
}

}  // namespace hindsight
