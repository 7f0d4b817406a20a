#include "attitude/field_survey.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "geometry/so3.h"

namespace hindsight {
namespace {

struct Weighed {
  double value = 0.0;
  double weight = 0.0;
};

double WeighedMedian(std::vector<Weighed> values) {
  std::sort(
      values.begin(), values.end(),
      [](const Weighed& a, const Weighed& b) { return a.value < b.value; });
  double half = 0.0;
  for (const Weighed& value : values) half += 0.5 * value.weight;
  for (const Weighed& value : values) {
    half -= value.weight;
    if (half <= 0.0) return value.value;
  }
  return 0.0;
}

/// Sets the reference to the medians.
void FindReference(std::span<const SurveyedField> readings,
                   FieldSurvey* survey) {
  constexpr double kMotion = 0.02;  // weight beside a reading at rest
  std::vector<Weighed> horizontal, north, east, down;
  for (const SurveyedField& reading : readings) {
    const Eigen::Vector3d field_n = reading.q_nb * reading.field_b;
    const double weight = reading.dt * (reading.at_rest ? 1.0 : kMotion);
    horizontal.push_back({field_n.head<2>().norm(), weight});
    north.push_back({field_n.x(), weight});
    east.push_back({field_n.y(), weight});
    down.push_back({field_n.z(), weight});
  }
  survey->horizontal = WeighedMedian(std::move(horizontal));
  survey->azimuth = std::atan2(WeighedMedian(std::move(east)),
                               WeighedMedian(std::move(north)));
  survey->down = WeighedMedian(std::move(down));
}

/// Azimuth of the median of the undisturbed readings at rest or in motion; of
/// less than kLeast there is none.
std::optional<double> MedianAzimuth(std::span<const SurveyedField> readings,
                                    const std::vector<double>& weight,
                                    bool at_rest) {
  constexpr double kLeast = 5.0;  // [s]
  double time = 0.0;
  std::vector<Weighed> north, east;
  for (std::size_t k = 0; k < readings.size(); ++k) {
    const SurveyedField& reading = readings[k];
    if (reading.at_rest != at_rest || weight[k] <= 0.0) continue;
    const Eigen::Vector3d field_n = reading.q_nb * reading.field_b;
    north.push_back({field_n.x(), reading.dt});
    east.push_back({field_n.y(), reading.dt});
    time += reading.dt;
  }
  if (time < kLeast) return std::nullopt;
  return std::atan2(WeighedMedian(std::move(east)),
                    WeighedMedian(std::move(north)));
}

/// What a reading differs in from the reference, as far as it can be told
/// [uT]: along and across it, and down.
Eigen::Vector3d Difference(const SurveyedField& reading,
                           const FieldSurvey& survey, bool heading_known) {
  const Eigen::Vector3d field_n = reading.q_nb * reading.field_b;
  const double c = std::cos(survey.azimuth);
  const double s = std::sin(survey.azimuth);
  const double along = heading_known ? c * field_n.x() + s * field_n.y()
                                     : field_n.head<2>().norm();
  const double across = heading_known ? c * field_n.y() - s * field_n.x() : 0.0;
  return {along - survey.horizontal, across, field_n.z() - survey.down};
}

}  // namespace

FieldSurvey SurveyField(std::span<const SurveyedField> readings,
                        const SurveyOptions& options) {
  constexpr double kSigmas = 3.0;
  const double limit = kSigmas * options.sigma;
  FieldSurvey survey;
  FindReference(readings, &survey);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double squares = 0.0;
  for (const SurveyedField& reading : readings) {
    const Eigen::Vector3d d =
        Difference(reading, survey, options.heading_known);
    const bool disturbed = options.reject && d.norm() > limit;
    survey.weight.push_back(disturbed ? 0.0 : 1.0);
    if (disturbed || reading.at_rest) continue;
    sum += reading.dt * d;
    squares += reading.dt * d.squaredNorm();
  }
  if (options.heading_known) {
    const auto rest = MedianAzimuth(readings, survey.weight, true);
    const auto motion = MedianAzimuth(readings, survey.weight, false);
    if (rest && motion) survey.turn = WrapAngle(*motion - *rest);
  }
  // T |sum / T|^2 / (squares / T)
  survey.memory = options.correlation_time;
  if (squares > 0.0) {
    survey.memory = std::max(survey.memory, sum.squaredNorm() / squares);
  }
  for (std::size_t k = 0; k < readings.size(); ++k) {
    const double time =
        readings[k].at_rest ? options.correlation_time : survey.memory;
    survey.weight[k] *= std::min(1.0, readings[k].dt / time);
  }
  return survey;
}

namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double kFirstScale = 5.0;  // [uT]

/// A reading of the search.
struct IronReading {
  Eigen::Matrix3d C_bn;
  Eigen::Vector3d field_b;
  double weight = 1.0;
  double dt = 0.0;     ///< that it stands for [s]
  double trust = 1.0;  ///< 1 / (1 + r^2 / (freedom scale^2))
};

/// Even field and hard iron, and what speaks for them.
struct IronFit {
  Eigen::Vector3d field_n = Eigen::Vector3d::Zero();
  Eigen::Vector3d hard_iron_b = Eigen::Vector3d::Zero();
  double log_likelihood = 0.0;
  double significance = 0.0;  ///< h' P_h^-1 h
};

/// The most likely ones for the present trust.
void SolveIron(std::span<const IronReading> readings, double scale,
               IronFit* fit) {
  constexpr double kWidest = 100.0;  // of a hard iron [uT]
  Matrix6 N = Matrix6::Zero();
  Vector6 y = Vector6::Zero();
  for (const IronReading& reading : readings) {
    Eigen::Matrix<double, 3, 6> H;
    H << reading.C_bn, Eigen::Matrix3d::Identity();
    const double w = reading.weight * reading.trust / (scale * scale);
    N.noalias() += w * H.transpose() * H;
    y.noalias() += w * H.transpose() * reading.field_b;
  }
  N.diagonal().array() += 1.0 / (kWidest * kWidest);
  const Vector6 x = N.ldlt().solve(y);
  fit->field_n = x.head<3>();
  fit->hard_iron_b = x.tail<3>();
  const Eigen::Matrix3d P = N.inverse().bottomRightCorner<3, 3>();
  fit->significance = fit->hard_iron_b.dot(P.ldlt().solve(x.tail<3>()));
}

/// Trust and likelihood of every reading at `scale`; returns the scale that
/// they make most likely.
double JudgeReadings(std::span<IronReading> readings, double scale,
                     double freedom, IronFit* fit) {
  const double constant = std::lgamma(0.5 * (freedom + 3.0)) -
                          std::lgamma(0.5 * freedom) -
                          1.5 * std::log(freedom * scale * scale);
  fit->log_likelihood = 0.0;
  double sum = 0.0;
  double count = 0.0;
  for (IronReading& reading : readings) {
    const double r2 =
        (reading.field_b - fit->hard_iron_b - reading.C_bn * fit->field_n)
            .squaredNorm();
    const double d2 = r2 / (scale * scale);
    reading.trust = 1.0 / (1.0 + d2 / freedom);
    const double w = reading.weight;
    fit->log_likelihood +=
        w * (constant - 0.5 * (freedom + 3.0) * std::log1p(d2 / freedom));
    sum += w * (freedom + 3.0) / (freedom + d2) * r2;
    count += 3.0 * w;
  }
  return count > 0.0 ? std::sqrt(sum / count) : scale;
}

IronFit FitIron(std::vector<IronReading> readings, double freedom) {
  constexpr double kLeast = 1.0;  // [uT], of a MEMS magnetometer in a room
  constexpr int kSteps = 16;
  IronFit fit;
  // From wide scales down, lest the first guess decide what is an outlier.
  for (const double widening : {16.0, 8.0, 4.0, 2.0}) {
    SolveIron(readings, widening * kFirstScale, &fit);
    JudgeReadings(readings, widening * kFirstScale, freedom, &fit);
  }
  double scale = kFirstScale;
  for (int step = 0; step < kSteps; ++step) {
    SolveIron(readings, scale, &fit);
    scale = std::max(JudgeReadings(readings, scale, freedom, &fit), kLeast);
  }
  return fit;
}

IronFit MostLikelyIron(const std::vector<IronReading>& readings) {
  IronFit best = FitIron(readings, 1.0);
  for (const double freedom : {2.0, 4.0, 8.0}) {
    const IronFit fit = FitIron(readings, freedom);
    if (fit.log_likelihood > best.log_likelihood) best = fit;
  }
  return best;
}

/// Whether nine in ten readings, by weight and by time, are nearer to the field
/// with the hard iron than to the one without.
bool IsThereAllTheTime(std::span<const IronReading> readings,
                       const IronFit& fit) {
  constexpr double kShare = 0.9;
  double weight = 0.0;
  double time = 0.0;
  for (const IronReading& reading : readings) {
    const Eigen::Vector3d without =
        reading.field_b - reading.C_bn * fit.field_n;
    const bool nearer =
        (without - fit.hard_iron_b).squaredNorm() < without.squaredNorm();
    const double count = (nearer ? 1.0 : 0.0) - kShare;
    weight += count * reading.weight;
    time += count * reading.dt;
  }
  return weight > 0.0 && time > 0.0;
}

}  // namespace

Eigen::Vector3d FindHardIron(std::span<const SurveyedField> readings) {
  constexpr double kSignificant = 21.1;  // chi-square, 3 degrees, 99.99 %
  std::vector<IronReading> all;
  for (std::size_t k = 0; k < readings.size(); ++k) {
    const SurveyedField& before = readings[k > 0 ? k - 1 : 0];
    const SurveyedField& reading = readings[k];
    const double angle = before.q_nb.angularDistance(reading.q_nb);
    all.push_back({reading.q_nb.conjugate().toRotationMatrix(), reading.field_b,
                   IndependentPart(reading.dt, angle), reading.dt});
  }
  const IronFit fit = MostLikelyIron(all);
  const bool found = fit.significance > kSignificant &&
                     fit.hard_iron_b.norm() > kLeastHardIron &&
                     IsThereAllTheTime(all, fit);
  return found ? fit.hard_iron_b : Eigen::Vector3d::Zero();
}

double IndependentPart(double dt, double angle) {
  constexpr double kFastest = 1.0;   // [s]
  constexpr double kSlowest = 50.0;  // [s]
  constexpr double kAngle = 0.5;     // [rad]
  return std::min(1.0, std::min(dt / kFastest, angle / kAngle) + dt / kSlowest);
}

}  // namespace hindsight
