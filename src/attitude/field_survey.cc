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

/// Of the azimuth in motion, the rest is that of the one at rest.
double WeightOfMotion(const FieldSurvey& survey) {
  const double place = 0.5 * survey.turn * survey.turn;
  if (place <= 0.0) return 0.5;
  return (place + survey.iron_variance) / (2.0 * place + survey.iron_variance);
}

}  // namespace

double RestAzimuth(const FieldSurvey& survey) {
  return -WeightOfMotion(survey) * survey.turn;
}

double NorthSigma(const FieldSurvey& survey) {
  return std::sqrt(0.5 * WeightOfMotion(survey)) * std::abs(survey.turn);
}

double PlaceSigma(const FieldSurvey& survey,
                  const MagneticSurroundings& stated) {
  const double area =
      stated.horizontal * survey.down - stated.down * survey.horizontal;
  return std::abs(area) /
         (std::hypot(stated.horizontal, stated.down) * survey.horizontal);
}

FieldSurvey SurveyField(std::span<const SurveyedField> readings,
                        const SurveyOptions& options) {
  constexpr double kSigmas = 3.0;
  const double limit = kSigmas * options.sigma;
  FieldSurvey survey;
  FindReference(readings, &survey);
  if (survey.horizontal > 0.0) {
    // Of one of three axes.
    const double part = options.weak_iron / survey.horizontal;
    survey.iron_variance = part * part / 3.0;
  }
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

}  // namespace hindsight
