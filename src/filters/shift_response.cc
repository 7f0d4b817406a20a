#include "filters/shift_response.h"

#include <utility>

#include "filters/tape_adjoint.h"
#include "filters/tape_gains.h"

namespace hindsight {
namespace {

/// A deviation as large as `sizes` says at each epoch, or a jump of the state.
struct Course {
  bool of_state = false;
  std::size_t onset = 0;
  int component = 0;  ///< of the state, that jumps
  ShiftColumns::Group group = 0;
  bool is_driven = false;  ///< by ShiftColumns::driven, not measured
  std::vector<int> columns = {};
  Eigen::MatrixXd sizes = {};  ///< a row an epoch

  /// What its columns add up to at an epoch.
  Eigen::VectorXd Sum(std::size_t k, const Eigen::MatrixXd& B) const {
    return B(Eigen::all, columns) *
           sizes.row(static_cast<Eigen::Index>(k)).transpose();
  }
};

/// What it adds to a measurement of epoch k.
Eigen::VectorXd AddedTo(const TapeMeasurement& z, const Course& course,
                        std::size_t k, const ShiftColumns& columns) {
  Eigen::VectorXd added = Eigen::VectorXd::Zero(z.H.rows());
  if (course.of_state || course.is_driven || k < course.onset) return added;
  for (const ShiftColumns::Columns& one : columns.measured(k, z)) {
    if (one.group == course.group) added = course.Sum(k, one.B);
  }
  return added;
}

/// What it adds to the true state by epoch k.
ErrorVector AddedTo(std::size_t k, const Course& course, const LinearTape& tape,
                    const ShiftColumns& columns) {
  ErrorVector added = ErrorVector::Zero(tape.dim());
  if (course.of_state) {
    if (k == course.onset) added(course.component) = 1.0;
  } else if (k > course.onset && course.is_driven) {
    added = course.Sum(k, columns.driven(k).B);
  }
  return added;
}

/// By what it makes the estimates of the filter differ from the true states. Not
/// each of them: both go with the free inertial navigation, whose heights grow
/// by e every ten minutes.
struct Response {
  Eigen::MatrixXd minus;               ///< a column an epoch
  std::vector<RowVector> innovations;  ///< that it causes, of all measurements
};

Response Filtered(const Course& course, const LinearTape& tape,
                  const ShiftColumns& columns) {
  Response out;
  out.minus.resize(tape.dim(), static_cast<Eigen::Index>(tape.size()));
  ErrorVector error = ErrorVector::Zero(tape.dim());
  for (std::size_t k = 0; k < tape.size(); ++k) {
    if (k > 0) error = (tape.Phi(k) * error).eval();
    error += AddedTo(k, course, tape, columns);
    out.minus.col(static_cast<Eigen::Index>(k)) = error;
    const auto all = tape.measurements(k);
    for (const auto& z : all) {
      RowVector& innovation = out.innovations.emplace_back();
      if (!z.accepted) continue;
      innovation = z.H * error + AddedTo(z, course, k, columns);
      error -= z.K * innovation;
    }
  }
  return out;
}

Eigen::MatrixXd CorrectionForCourse(Course course, const LinearTape& tape,
                                    const ShiftColumns& columns) {
  RequireFixedNominal(tape);
  course.is_driven = columns.driven && tape.size() > 1 &&
                     columns.driven(1).group == course.group;
  Response response = Filtered(course, tape, columns);
  Eigen::MatrixXd correction = std::move(response.minus);
  ErrorVector lambda = ErrorVector::Zero(tape.dim());
  for (std::size_t k = tape.size(); k-- > 0;) {
    if (k + 1 < tape.size()) {
      lambda = (tape.Phi(k + 1).transpose() * lambda).eval();
    }
    const auto all = tape.measurements(k);
    for (std::size_t i = all.size(); i-- > 0;) {
      if (all[i].accepted) {
        lambda = LambdaBefore(all[i], response.innovations.back(), lambda);
      }
      response.innovations.pop_back();
    }
    correction.col(static_cast<Eigen::Index>(k)) -= tape.P_minus(k) * lambda;
  }
  return correction;
}

}  // namespace

Eigen::MatrixXd CorrectionFor(const MeanShift& shift, const LinearTape& tape,
                              const ShiftColumns& columns) {
  Course course{.of_state = shift.of_state, .onset = shift.onset};
  if (shift.of_state) {
    course.component = shift.column;
  } else {
    course.group = shift.group;
    course.columns = {shift.column};
    course.sizes.setZero(static_cast<Eigen::Index>(tape.size()), 1);
    for (std::size_t k = shift.onset; k < tape.size(); ++k) {
      course.sizes(static_cast<Eigen::Index>(k), 0) =
          shift.grows ? tape.t(k) - tape.t(shift.onset) : 1.0;
    }
  }
  return CorrectionForCourse(std::move(course), tape, columns);
}

Eigen::MatrixXd CorrectionForSteps(ShiftColumns::Group group,
                                   std::span<const int> wanted,
                                   std::span<const std::size_t> onsets,
                                   const Eigen::MatrixXd& steps,
                                   const LinearTape& tape,
                                   const ShiftColumns& columns) {
  Course course{.onset = onsets.front(), .group = group};
  course.columns.assign(wanted.begin(), wanted.end());
  course.sizes.setZero(static_cast<Eigen::Index>(tape.size()), steps.cols());
  for (Eigen::Index i = 0; i < steps.rows(); ++i) {
    const auto onset =
        static_cast<Eigen::Index>(onsets[static_cast<std::size_t>(i)]);
    course.sizes.bottomRows(course.sizes.rows() - onset).rowwise() +=
        steps.row(i);
  }
  return CorrectionForCourse(std::move(course), tape, columns);
}

}  // namespace hindsight
