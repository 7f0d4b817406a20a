#ifndef HINDSIGHT_DATASET_ALLAN_H_
#define HINDSIGHT_DATASET_ALLAN_H_

#include <array>
#include <optional>
#include <vector>

#include "dataset/time_interval.h"
#include "imu/imu_stream.h"

namespace hindsight {

/// The overlapping Allan deviation at one cluster time.
struct AllanPoint {
  double tau = 0.0;        ///< [s]
  double deviation = 0.0;  ///< of the readings, SI
  /// Standard deviation of ln(deviation): 1/sqrt(2 (N/m - 1)), N samples in
  /// clusters of m (IEEE Std 952-1997, C.3).
  double log_sigma = 0.0;
};

/// Of x(k), dt apart, with theta its sum times dt:
///   sigma^2(m dt) = 1/(2 (m dt)^2 (N - 2m)) sum (theta(k + 2m) - 2 theta(k + m)
///                   + theta(k))^2,
/// at m in steps of a seventh of a decade up to N/9. Empty if N < 30.
std::vector<AllanPoint> AllanDeviation(const std::vector<double>& x, double dt);

/// A coefficient and its standard deviation.
struct AllanCoefficient {
  double value = 0.0;
  double sigma = 0.0;
};

/// sigma^2(tau) = N^2 / tau + (2 ln 2 / pi) B^2 + K^2 tau / 3.
struct AllanFit {
  AllanCoefficient white;        ///< N, density
  AllanCoefficient instability;  ///< B
  AllanCoefficient walk;         ///< K, density of the bias's walk
};

/// By least squares of the variances in units of their sigmas, none of the three
/// negative; a coefficient that comes out at zero has the sigma of what would not
/// be seen. Points share their data: the sigmas allow for the correlation that
/// the fitted spectrum gives them.
AllanFit FitAllan(const std::vector<AllanPoint>& points);

/// Names of the axes, in the order of ImuAllan.
inline constexpr std::array kAllanAxes = {"gyro x",  "gyro y",  "gyro z",
                                          "accel x", "accel y", "accel z"};

/// Of each axis over a span: gyros x, y, z, then accelerometers.
struct ImuAllan {
  TimeInterval span;
  std::array<std::vector<AllanPoint>, 6> points;
  std::array<AllanFit, 6> fits;
};

/// Nothing if the span holds fewer than 1000 samples.
std::optional<ImuAllan> AllanOf(const ImuStream& imu, const TimeInterval& span);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_ALLAN_H_
