#include "problems/field_survey.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace hindsight {
namespace {

constexpr double kNoiseScale = 2.0;     // [uT]
constexpr double kHardIronScale = 0.5;  // [uT]

}  // namespace

FieldSurvey SurveyField(std::span<const SurveyedField> readings) {
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  FieldSurvey survey;
  survey.trust.assign(readings.size(), 1.0);
  // From no hard iron and wide scales to the true ones, lest the first guess
  // decide what is an outlier.
  for (const double widening : {16.0, 8.0, 4.0, 2.0, 1.0, 1.0, 1.0, 1.0}) {
    const double scale = widening * kNoiseScale;
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
    const double h2 = survey.hard_iron_b.squaredNorm();
    const double prior =
        widening * widening * kHardIronScale * kHardIronScale + h2;
    N.diagonal().tail<3>().array() += 1.0 / prior;
    const Vector6 x = N.ldlt().solve(y);
    survey.field_n = x.head<3>();
    survey.hard_iron_b = x.tail<3>();
    for (std::size_t k = 0; k < readings.size(); ++k) {
      const Eigen::Vector3d r = readings[k].field_b - survey.hard_iron_b -
                                readings[k].q_nb.conjugate() * survey.field_n;
      survey.trust[k] = 1.0 / (1.0 + r.squaredNorm() / (scale * scale));
    }
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
