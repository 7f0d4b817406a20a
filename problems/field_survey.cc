#include "problems/field_survey.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace hindsight {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// The survey with or without a hard iron; with one, h' P_h^-1 h goes to
/// `significance`.
FieldSurvey Fit(std::span<const SurveyedField> readings, bool hard_iron,
                double* significance) {
  constexpr double kWidest = 100.0;  // of a hard iron [uT]
  FieldSurvey survey;
  survey.trust.assign(readings.size(), 1.0);
  // From wide scales to the true one, lest the first guess decide what is an
  // outlier.
  for (const double widening : {16.0, 8.0, 4.0, 2.0, 1.0, 1.0, 1.0, 1.0}) {
    const double scale = widening * kFieldScale;
    Matrix6 N = Matrix6::Zero();
    Vector6 y = Vector6::Zero();
    for (std::size_t k = 0; k < readings.size(); ++k) {
      const SurveyedField& reading = readings[k];
      Eigen::Matrix<double, 3, 6> H;
      H << reading.q_nb.conjugate().toRotationMatrix(),
          Eigen::Matrix3d::Identity();
      const double w = reading.weight * survey.trust[k] / (scale * scale);
      N.noalias() += w * H.transpose() * H;
      y.noalias() += w * H.transpose() * reading.field_b;
    }
    N.diagonal().tail<3>().array() += 1.0 / (kWidest * kWidest);
    if (hard_iron) {
      const Vector6 x = N.ldlt().solve(y);
      survey.field_n = x.head<3>();
      survey.hard_iron_b = x.tail<3>();
      const Eigen::Matrix3d P = N.inverse().bottomRightCorner<3, 3>();
      *significance = survey.hard_iron_b.dot(P.ldlt().solve(x.tail<3>()));
    } else {
      survey.field_n = N.topLeftCorner<3, 3>().ldlt().solve(y.head<3>().eval());
    }
    for (std::size_t k = 0; k < readings.size(); ++k) {
      const Eigen::Vector3d r = readings[k].field_b - survey.hard_iron_b -
                                readings[k].q_nb.conjugate() * survey.field_n;
      survey.trust[k] = 1.0 / (1.0 + r.squaredNorm() / (scale * scale));
    }
  }
  return survey;
}

}  // namespace

FieldSurvey SurveyField(std::span<const SurveyedField> readings) {
  constexpr double kSignificant = 21.1;  // chi-square, 3 degrees, 99.99 %
  double significance = 0.0;
  FieldSurvey survey = Fit(readings, true, &significance);
  if (significance < kSignificant || survey.hard_iron_b.norm() < kFieldScale) {
    survey = Fit(readings, false, nullptr);
  }
  return survey;
}

double IndependentPart(double dt, double angle) {
  constexpr double kFastest = 1.0;   // [s]
  constexpr double kSlowest = 50.0;  // [s]
  constexpr double kAngle = 0.5;     // [rad]
  return std::min(1.0, std::min(dt / kFastest, angle / kAngle) + dt / kSlowest);
}

}  // namespace hindsight
