#include "attitude/magnetometer_errors.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/median.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

/// Even field, hard iron, time offset, turn.
constexpr int kUnknowns = 10;
using Information = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;

constexpr double kFirstScale = 5.0;  // [uT]

/// A reading of the search.
struct ErrorReading {
  Eigen::Matrix3d C_bn;
  Eigen::Vector3d field_b;
  Eigen::Vector3d w_b;
  double weight = 1.0;
  double dt = 0.0;     ///< that it stands for [s]
  double trust = 1.0;  ///< 1 / (1 + r^2 / (freedom scale^2))
};

/// A priori sigmas; 0: there is no such error.
struct ErrorPriors {
  double time_offset = 0.0;  ///< [s]
  double turn = 0.0;         ///< [rad]
};

/// x' P^-1 x of three unknowns.
double Significance(const Eigen::Vector3d& x, const Eigen::Matrix3d& P) {
  return x.dot(P.ldlt().solve(x));
}

/// Even field and errors, and what speaks for them.
struct ErrorFit {
  Eigen::Vector3d field_n = Eigen::Vector3d::Zero();
  MagnetometerErrors errors;
  Eigen::Vector3d turn_b = Eigen::Vector3d::Zero();
  double freedom = 0.0;
  double log_likelihood = 0.0;
  double significance = 0.0;       ///< h' P_h^-1 h
  double turn_significance = 0.0;  ///< of the turn likewise

  /// Derivative of what is read by the time offset [uT/s].
  Eigen::Vector3d ByTimeOffset(const ErrorReading& reading) const {
    return (reading.C_bn * field_n).cross(reading.w_b);
  }
  /// Derivative by the turn [uT/rad].
  Eigen::Matrix3d ByTurn(const ErrorReading& reading) const {
    return -Skew(reading.C_bn * field_n);
  }
  /// Reading less all but the hard iron [uT].
  Eigen::Vector3d Rest(const ErrorReading& reading) const {
    return reading.field_b - reading.C_bn * field_n -
           errors.time_offset * ByTimeOffset(reading) -
           ByTurn(reading) * turn_b;
  }
};

/// The most likely ones for the present trust; time offset and turn in units of
/// their a priori sigmas, about the present field.
void SolveErrors(std::span<const ErrorReading> readings, double scale,
                 const ErrorPriors& priors, ErrorFit* fit) {
  constexpr double kWidest = 100.0;  // of a hard iron [uT]
  Information N = Information::Zero();
  Unknowns y = Unknowns::Zero();
  for (const ErrorReading& reading : readings) {
    Eigen::Matrix<double, 3, kUnknowns> H;
    H << reading.C_bn, Eigen::Matrix3d::Identity(),
        priors.time_offset * fit->ByTimeOffset(reading),
        priors.turn * fit->ByTurn(reading);
    const double w = reading.weight * reading.trust / (scale * scale);
    // Matrices of this size are faster without Eigen's blocking.
    const Eigen::Matrix<double, kUnknowns, 3> weighed = w * H.transpose();
    N += weighed.lazyProduct(H);
    y += weighed.lazyProduct(reading.field_b);
  }
  N.diagonal().head<6>().array() += 1.0 / (kWidest * kWidest);
  N.diagonal().tail<4>().array() += 1.0;
  const Unknowns x = N.ldlt().solve(y);
  const Information P = N.inverse();
  fit->field_n = x.head<3>();
  fit->errors.hard_iron_b = x.segment<3>(3);
  fit->errors.time_offset = priors.time_offset * x(6);
  fit->errors.time_offset_sigma = priors.time_offset * std::sqrt(P(6, 6));
  fit->turn_b = priors.turn * x.tail<3>();
  fit->significance = Significance(x.segment<3>(3), P.block<3, 3>(3, 3));
  fit->turn_significance =
      Significance(x.tail<3>(), P.bottomRightCorner<3, 3>());
}

/// Squared distance of a reading from what the fit says [uT^2].
double SquaredDistance(const ErrorReading& reading, const ErrorFit& fit) {
  return (fit.Rest(reading) - fit.errors.hard_iron_b).squaredNorm();
}

/// Trust of every reading at `scale`; returns the scale that they make most
/// likely.
double JudgeReadings(std::span<ErrorReading> readings, double scale,
                     double freedom, const ErrorFit& fit) {
  double sum = 0.0;
  double count = 0.0;
  for (ErrorReading& reading : readings) {
    const double r2 = SquaredDistance(reading, fit);
    const double d2 = r2 / (scale * scale);
    reading.trust = 1.0 / (1.0 + d2 / freedom);
    const double w = reading.weight;
    sum += w * (freedom + 3.0) / (freedom + d2) * r2;
    count += 3.0 * w;
  }
  return count > 0.0 ? std::sqrt(sum / count) : scale;
}

double LogLikelihood(std::span<const ErrorReading> readings, double scale,
                     double freedom, const ErrorFit& fit) {
  const double constant = std::lgamma(0.5 * (freedom + 3.0)) -
                          std::lgamma(0.5 * freedom) -
                          1.5 * std::log(freedom * scale * scale);
  double sum = 0.0;
  for (const ErrorReading& reading : readings) {
    const double d2 = SquaredDistance(reading, fit) / (scale * scale);
    sum += reading.weight *
           (constant - 0.5 * (freedom + 3.0) * std::log1p(d2 / freedom));
  }
  return sum;
}

ErrorFit FitErrors(std::vector<ErrorReading> readings, double freedom,
                   const ErrorPriors& priors) {
  constexpr double kLeast = 1.0;  // [uT], of a MEMS magnetometer in a room
  constexpr int kSteps = 16;
  ErrorFit fit;
  fit.freedom = freedom;
  // From wide scales down, lest the first guess decide what is an outlier.
  for (const double widening : {16.0, 8.0, 4.0, 2.0}) {
    SolveErrors(readings, widening * kFirstScale, priors, &fit);
    JudgeReadings(readings, widening * kFirstScale, freedom, fit);
  }
  double scale = kFirstScale;
  double next = scale;
  for (int step = 0; step < kSteps; ++step) {
    scale = next;
    SolveErrors(readings, scale, priors, &fit);
    next = std::max(JudgeReadings(readings, scale, freedom, fit), kLeast);
  }
  fit.log_likelihood = LogLikelihood(readings, scale, freedom, fit);
  return fit;
}

ErrorFit MostLikelyErrors(const std::vector<ErrorReading>& readings,
                          const ErrorPriors& priors) {
  ErrorFit best = FitErrors(readings, 1.0, priors);
  for (const double freedom : {2.0, 4.0, 8.0}) {
    const ErrorFit fit = FitErrors(readings, freedom, priors);
    if (fit.log_likelihood > best.log_likelihood) best = fit;
  }
  return best;
}

/// Whether nine in ten readings, by weight and by time, are nearer to the field
/// with the hard iron than to the one without.
bool IsThereAllTheTime(std::span<const ErrorReading> readings,
                       const ErrorFit& fit) {
  constexpr double kShare = 0.9;
  double weight = 0.0;
  double time = 0.0;
  for (const ErrorReading& reading : readings) {
    const Eigen::Vector3d without = fit.Rest(reading);
    const bool nearer = (without - fit.errors.hard_iron_b).squaredNorm() <
                        without.squaredNorm();
    const double count = (nearer ? 1.0 : 0.0) - kShare;
    weight += count * reading.weight;
    time += count * reading.dt;
  }
  return weight > 0.0 && time > 0.0;
}

/// As MagnetometerErrors::scatter, of the readings that count for a tenth of an
/// independent one or more.
std::optional<double> Scatter(std::span<const ErrorReading> readings,
                              const ErrorFit& fit) {
  constexpr double kPart = 0.1;
  constexpr std::size_t kLeast = 100;
  constexpr double kMedian = 1.5382;  // of the length of three N(0, 1)
  std::vector<double> distances;
  for (const ErrorReading& reading : readings) {
    if (reading.weight < kPart) continue;
    distances.push_back((fit.Rest(reading) - fit.errors.hard_iron_b).norm());
  }
  if (distances.size() < kLeast) return std::nullopt;
  return Median(std::move(distances)) / kMedian;
}

}  // namespace

MagnetometerErrors FindMagnetometerErrors(
    std::span<const SurveyedField> readings, double time_offset_sigma) {
  constexpr double kSignificant = 21.1;  // chi-square, 3 degrees, 99.99 %
  constexpr double kTurnSigma = 10.0 * kDegree;
  std::vector<ErrorReading> all;
  all.reserve(readings.size());
  for (std::size_t k = 0; k < readings.size(); ++k) {
    const SurveyedField& before = readings[k > 0 ? k - 1 : 0];
    const SurveyedField& reading = readings[k];
    const double angle = before.q_nb.angularDistance(reading.q_nb);
    all.push_back({reading.q_nb.conjugate().toRotationMatrix(), reading.field_b,
                   reading.w_b, IndependentPart(reading.dt, angle),
                   reading.dt});
  }
  const ErrorFit fit = MostLikelyErrors(all, {time_offset_sigma});
  MagnetometerErrors errors = fit.errors;
  const bool found = fit.significance > kSignificant &&
                     errors.hard_iron_b.norm() > kLeastHardIron &&
                     IsThereAllTheTime(all, fit);
  if (!found) {
    errors.weak_iron = errors.hard_iron_b.norm();
    errors.hard_iron_b.setZero();
  }
  if (time_offset_sigma == 0.0) {
    constexpr double kUnstatedOffset = 0.1;  // [s]
    const ErrorFit late = FitErrors(all, fit.freedom, {kUnstatedOffset});
    errors.apparent_offset = late.errors.time_offset;
    errors.apparent_offset_sigma = late.errors.time_offset_sigma;
  }
  const ErrorFit turned =
      FitErrors(all, fit.freedom, {time_offset_sigma, kTurnSigma});
  const bool is_turned = turned.turn_significance > kSignificant &&
                         turned.turn_b.norm() > kLeastTurn;
  if (is_turned) errors.turn_b = turned.turn_b;
  errors.scatter = Scatter(all, is_turned ? turned : fit);
  return errors;
}

double IndependentPart(double dt, double angle) {
  constexpr double kFastest = 1.0;   // [s]
  constexpr double kSlowest = 50.0;  // [s]
  constexpr double kAngle = 0.5;     // [rad]
  return std::min(1.0, std::min(dt / kFastest, angle / kAngle) + dt / kSlowest);
}

}  // namespace hindsight
