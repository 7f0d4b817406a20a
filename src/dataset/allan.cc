#include "dataset/allan.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"
#include "imu/sample_search.h"

namespace hindsight {
namespace {

constexpr double kPointsPerDecade = 7.0;
/// B^2 in the variance.
constexpr double kInstability = 2.0 * 0.69314718055994531 / kPi;

double VarianceAt(const std::vector<double>& theta, std::size_t m, double dt) {
  const std::size_t count = theta.size() - 2 * m;
  double sum = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const double second = theta[k + 2 * m] - 2.0 * theta[k + m] + theta[k];
    sum += second * second;
  }
  const double tau = static_cast<double>(m) * dt;
  return sum / (2.0 * tau * tau * static_cast<double>(count));
}

/// Which of the three terms take part.
using Taken = std::array<bool, 3>;

struct Solved {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  /// d x / d variance, a column a point.
  Eigen::Matrix3Xd gain;
  Taken taken = {};
  double misfit = std::numeric_limits<double>::infinity();
};

Eigen::Vector3d Terms(double tau) {
  return {1.0 / tau, kInstability, tau / 3.0};
}

/// Least squares of the variances, each in units of its sigma.
Solved SolveWith(const std::vector<AllanPoint>& points, const Taken& taken,
                 const std::vector<double>& sigmas) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double w = 1.0 / (sigmas[i] * sigmas[i]);
    Eigen::Vector3d h = Terms(points[i].tau);
    for (Eigen::Index j = 0; j < 3; ++j) {
      if (!taken[static_cast<std::size_t>(j)]) h(j) = 0.0;
    }
    A += w * h * h.transpose();
    b += w * h * points[i].deviation * points[i].deviation;
  }
  // Terms of very different size: scaled to a unit diagonal.
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  for (Eigen::Index j = 0; j < 3; ++j) {
    if (A(j, j) > 0.0) scale(j) = 1.0 / std::sqrt(A(j, j));
  }
  Eigen::Matrix3d S = scale.asDiagonal() * A * scale.asDiagonal();
  for (Eigen::Index j = 0; j < 3; ++j) {
    if (!taken[static_cast<std::size_t>(j)]) S(j, j) = 1.0;
  }
  const Eigen::Matrix3d inverse = S.inverse();
  Solved solved;
  solved.taken = taken;
  const Eigen::Matrix3d P = scale.asDiagonal() * inverse * scale.asDiagonal();
  solved.x = P * b;
  solved.gain.resize(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    Eigen::Vector3d h = Terms(points[i].tau);
    for (Eigen::Index j = 0; j < 3; ++j) {
      if (!taken[static_cast<std::size_t>(j)]) h(j) = 0.0;
    }
    solved.gain.col(static_cast<Eigen::Index>(i)) =
        P * h / (sigmas[i] * sigmas[i]);
  }
  for (Eigen::Index j = 0; j < 3; ++j) {
    if (!taken[static_cast<std::size_t>(j)]) solved.x(j) = 0.0;
  }
  solved.misfit = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double r = (points[i].deviation * points[i].deviation -
                      Terms(points[i].tau).dot(solved.x)) /
                     sigmas[i];
    solved.misfit += r * r;
  }
  return solved;
}

/// The best of all subsets of terms whose coefficients are not negative.
Solved SolveNotNegative(const std::vector<AllanPoint>& points,
                        const std::vector<double>& sigmas) {
  Solved best;
  for (unsigned subset = 1; subset < 8; ++subset) {
    const Taken taken = {(subset & 1U) != 0, (subset & 2U) != 0,
                         (subset & 4U) != 0};
    const Solved here = SolveWith(points, taken, sigmas);
    if (here.x.minCoeff() < 0.0 || here.misfit >= best.misfit) continue;
    best = here;
  }
  return best;
}

/// Correlation of the variances at all pairs of cluster times: each is the power
/// of the readings, S = N^2 + B^2 / (2 pi f) + K^2 / (2 pi f)^2, through
/// sin^4(pi f tau) / (pi f tau)^2, and two of them covary by the integral of the
/// product over f.
Eigen::MatrixXd CorrelationOf(const std::vector<AllanPoint>& points,
                              const Eigen::Vector3d& x) {
  constexpr int kFrequencies = 2000;
  const double low = 0.02 / points.back().tau;
  const double high = 2.0 / points.front().tau;
  const auto count = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd power(kFrequencies, count);
  for (int i = 0; i < kFrequencies; ++i) {
    const double f =
        low * std::pow(high / low, (i + 0.5) / double{kFrequencies});
    const double w = 2.0 * kPi * f;
    const double S = x(0) + x(1) / w + x(2) / (w * w);
    for (Eigen::Index j = 0; j < count; ++j) {
      const double u = kPi * f * points[static_cast<std::size_t>(j)].tau;
      // sqrt(f): equal steps of ln f.
      power(i, j) = S * std::pow(std::sin(u), 4) / (u * u) * std::sqrt(f);
    }
  }
  const Eigen::MatrixXd covariance = power.transpose() * power;
  const Eigen::VectorXd scale =
      covariance.diagonal().cwiseSqrt().cwiseInverse();
  return scale.asDiagonal() * covariance * scale.asDiagonal();
}

Eigen::Vector3d VarianceOf(const Solved& solved,
                           const std::vector<double>& sigmas,
                           const Eigen::MatrixXd& correlation) {
  const Eigen::Map<const Eigen::VectorXd> s(
      sigmas.data(), static_cast<Eigen::Index>(sigmas.size()));
  const Eigen::Matrix3Xd weighted = solved.gain * s.asDiagonal();
  return (weighted * correlation * weighted.transpose()).diagonal();
}

/// The square root of a square and of its variance.
AllanCoefficient Root(double square, double variance) {
  const double sigma = std::sqrt(variance);
  if (square <= 0.0) return {0.0, std::sqrt(sigma)};
  const double value = std::sqrt(square);
  return {value, std::min(0.5 * sigma / value, std::sqrt(sigma))};
}

}  // namespace

std::vector<AllanPoint> AllanDeviation(const std::vector<double>& x,
                                       double dt) {
  constexpr std::size_t kFewest = 30;
  constexpr std::size_t kLargestShare = 9;
  if (x.size() < kFewest) return {};
  double mean = 0.0;
  for (const double value : x) mean += value;
  mean /= static_cast<double>(x.size());
  std::vector<double> theta(x.size() + 1, 0.0);
  for (std::size_t k = 0; k < x.size(); ++k) {
    theta[k + 1] = theta[k] + dt * (x[k] - mean);
  }
  std::vector<AllanPoint> points;
  std::size_t last = 0;
  for (double exponent = 0.0;; exponent += 1.0 / kPointsPerDecade) {
    const auto m =
        static_cast<std::size_t>(std::lround(std::pow(10.0, exponent)));
    if (m > x.size() / kLargestShare) return points;
    if (m == last) continue;
    last = m;
    const double clusters =
        static_cast<double>(x.size()) / static_cast<double>(m);
    points.push_back({static_cast<double>(m) * dt,
                      std::sqrt(VarianceAt(theta, m, dt)),
                      1.0 / std::sqrt(2.0 * (clusters - 1.0))});
  }
}

AllanFit FitAllan(const std::vector<AllanPoint>& points) {
  if (points.size() < 3) return {};
  // Sigmas of the variances by the model, so that a low point does not weigh
  // more than a high one; they begin as those of the points.
  std::vector<double> sigmas;
  for (const AllanPoint& point : points) {
    sigmas.push_back(2.0 * point.log_sigma * point.deviation * point.deviation);
  }
  Solved solved;
  constexpr int kSweeps = 5;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    solved = SolveNotNegative(points, sigmas);
    for (std::size_t i = 0; i < points.size(); ++i) {
      sigmas[i] =
          2.0 * points[i].log_sigma * Terms(points[i].tau).dot(solved.x);
    }
  }
  // The sigmas of what came out at zero are those of all three together.
  const Solved together = SolveWith(points, {true, true, true}, sigmas);
  const Eigen::MatrixXd correlation = CorrelationOf(points, solved.x);
  const Eigen::Vector3d variance = VarianceOf(solved, sigmas, correlation);
  const Eigen::Vector3d unseen = VarianceOf(together, sigmas, correlation);
  const auto root = [&](Eigen::Index j) {
    return Root(solved.x(j), solved.x(j) > 0.0 ? variance(j) : unseen(j));
  };
  return {root(0), root(1), root(2)};
}

std::optional<ImuAllan> AllanOf(const ImuStream& imu,
                                const TimeInterval& span) {
  constexpr std::size_t kFewest = 1000;
  const double dt = UsualInterval(imu);
  const double scale =
      imu.kind == ImuStream::Kind::kIncrements ? 1.0 / dt : 1.0;
  std::array<std::vector<double>, 6> series;
  for (std::size_t k = FirstSampleAfter(imu, span.begin);
       k < imu.samples.size() && imu.samples[k].t <= span.end; ++k) {
    const ImuSample& sample = imu.samples[k];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      series[i].push_back(scale * sample.gyro(axis));
      series[i + 3].push_back(scale * sample.accel(axis));
    }
  }
  if (series[0].size() < kFewest) return std::nullopt;
  ImuAllan allan;
  allan.span = span;
  for (std::size_t i = 0; i < series.size(); ++i) {
    allan.points[i] = AllanDeviation(series[i], dt);
    allan.fits[i] = FitAllan(allan.points[i]);
  }
  return allan;
}

}  // namespace hindsight
