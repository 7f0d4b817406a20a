#include "problems/field_survey.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

namespace hindsight {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// A survey and what speaks for it.
struct FieldFit {
  FieldSurvey survey;
  double log_likelihood = 0.0;
  double significance = 0.0;  ///< of the hard iron, h' P_h^-1 h
};

/// Mean of the noise about the survey, most likely for the present trust.
void SolveField(std::span<const SurveyedField> readings, double scale,
                bool hard_iron, FieldFit* fit) {
  constexpr double kWidest = 100.0;  // of a hard iron [uT]
  FieldSurvey& survey = fit->survey;
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
  if (!hard_iron) {
    survey.field_n = N.topLeftCorner<3, 3>().ldlt().solve(y.head<3>().eval());
    return;
  }
  const Vector6 x = N.ldlt().solve(y);
  survey.field_n = x.head<3>();
  survey.hard_iron_b = x.tail<3>();
  const Eigen::Matrix3d P = N.inverse().bottomRightCorner<3, 3>();
  fit->significance = survey.hard_iron_b.dot(P.ldlt().solve(x.tail<3>()));
}

/// Trust and likelihood of every reading at `scale`; returns the scale that
/// they make most likely.
double JudgeReadings(std::span<const SurveyedField> readings, double scale,
                     FieldFit* fit) {
  FieldSurvey& survey = fit->survey;
  const double nu = survey.freedom;
  const double constant = std::lgamma(0.5 * (nu + 3.0)) -
                          std::lgamma(0.5 * nu) -
                          1.5 * std::log(nu * scale * scale);
  fit->log_likelihood = 0.0;
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t k = 0; k < readings.size(); ++k) {
    const double r2 = (readings[k].field_b - survey.hard_iron_b -
                       readings[k].q_nb.conjugate() * survey.field_n)
                          .squaredNorm();
    const double d2 = r2 / (scale * scale);
    survey.trust[k] = 1.0 / (1.0 + d2 / nu);
    const double w = readings[k].weight;
    fit->log_likelihood +=
        w * (constant - 0.5 * (nu + 3.0) * std::log1p(d2 / nu));
    sum += w * (nu + 3.0) / (nu + d2) * r2;
    count += 3.0 * w;
  }
  return count > 0.0 ? std::sqrt(sum / count) : scale;
}

FieldFit FitField(std::span<const SurveyedField> readings, bool hard_iron,
                  double freedom) {
  constexpr double kLeast = 1.0;  // [uT], of a MEMS magnetometer in a room
  constexpr int kSteps = 16;
  FieldFit fit;
  fit.survey.trust.assign(readings.size(), 1.0);
  fit.survey.freedom = freedom;
  // From wide scales down, lest the first guess decide what is an outlier.
  for (const double widening : {16.0, 8.0, 4.0, 2.0}) {
    SolveField(readings, widening * kFieldScale, hard_iron, &fit);
    JudgeReadings(readings, widening * kFieldScale, &fit);
  }
  double scale = kFieldScale;
  for (int step = 0; step < kSteps; ++step) {
    SolveField(readings, scale, hard_iron, &fit);
    fit.survey.scale = scale;
    scale = std::max(JudgeReadings(readings, scale, &fit), kLeast);
  }
  return fit;
}

FieldFit MostLikelyField(std::span<const SurveyedField> readings,
                         bool hard_iron) {
  FieldFit best = FitField(readings, hard_iron, 1.0);
  for (const double freedom : {2.0, 4.0, 8.0}) {
    FieldFit fit = FitField(readings, hard_iron, freedom);
    if (fit.log_likelihood > best.log_likelihood) best = std::move(fit);
  }
  return best;
}

}  // namespace

FieldSurvey SurveyField(std::span<const SurveyedField> readings) {
  constexpr double kSignificant = 21.1;  // chi-square, 3 degrees, 99.99 %
  FieldFit fit = MostLikelyField(readings, true);
  if (fit.significance < kSignificant ||
      fit.survey.hard_iron_b.norm() < kFieldScale) {
    fit = MostLikelyField(readings, false);
  }
  return fit.survey;
}

double IndependentPart(double dt, double angle) {
  constexpr double kFastest = 1.0;   // [s]
  constexpr double kSlowest = 50.0;  // [s]
  constexpr double kAngle = 0.5;     // [rad]
  return std::min(1.0, std::min(dt / kFastest, angle / kAngle) + dt / kSlowest);
}

}  // namespace hindsight
