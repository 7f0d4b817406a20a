#ifndef HINDSIGHT_DATASET_ROW_RATE_H_
#define HINDSIGHT_DATASET_ROW_RATE_H_

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "imu/imu_stream.h"

namespace hindsight {

/// How well an IMU's rows balance gravity where they are written at some rate.
/// Whoever has the same velocity in two quiet spells, as a foot that stands
/// again, was held up by gravity alone between them: over the n rows of a span
///   r(dt) = 1/((n - 1) dt) int C f - f_0 = 0,  C(0) = I,  C' = C [(w - b) x]
/// over rows that are dt apart (ImuSummary::dv), with f_0 the mean of f in the
/// first spell and b the median of w in spells. Of the first 60 000 rows.
class GravityBalance {
 public:
  using Vectors = std::span<const Eigen::Vector3d>;
  /// As many of both, which outlive it: f in units of gravity, w [rad/s].
  GravityBalance(Vectors accel, Vectors gyro);

  /// From the end of a spell to the beginning of the next.
  struct Span {
    std::size_t begin = 0;
    std::size_t end = 0;
    Eigen::Vector3d f_0;
  };
  const std::vector<Span>& spans() const { return spans_; }

  /// r of every span at 1/dt = `rate` [Hz]; at an infinite one nothing turns.
  std::vector<Eigen::Vector3d> Residuals(double rate) const;
  /// Their sum of squares.
  double Squares(double rate) const;

 private:
  Vectors accel_;
  Vectors gyro_;
  Eigen::Vector3d bias_;
  ImuStream rows_;  ///< a unit of time apart
  std::vector<Span> spans_;
};

/// Where there are no more they say nothing.
inline constexpr std::size_t kFewestBalanced = 8;
/// What the turns must leave at most of the sum of squares without them.
inline constexpr double kMostUnbalanced = 0.25;

/// How many rows a second an IMU wrote whose rows have no stamps, as its motion
/// shows.
struct RowRate {
  double rate = 0.0;  ///< [Hz]
  /// Standard deviation of ln(rate), the random part: the edges of the spells
  /// leave some thousandths, and the gyros' scale is not in it.
  double log_sigma = 0.0;
  std::size_t spans = 0;  ///< that it was found from
};

/// The rate that balances gravity best (GravityBalance), by the sum of |r|^2. Its
/// sigma is that of least squares with unlike errors (White 1980), with
/// J_i = dr_i / dln(rate):
///   sigma^2 = sum (J_i r_i)^2 / (sum J_i^2)^2
/// Nothing where there are fewer than kFewestBalanced spans, ln(rate) is less
/// certain than 5 %, more than kMostUnbalanced is left, and outside of 10 to
/// 4000 Hz.
std::optional<RowRate> FindRowRate(std::span<const Eigen::Vector3d> accel,
                                   std::span<const Eigen::Vector3d> gyro);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_ROW_RATE_H_
