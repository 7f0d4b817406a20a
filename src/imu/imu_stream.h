#ifndef HINDSIGHT_IMU_IMU_STREAM_H_
#define HINDSIGHT_IMU_IMU_STREAM_H_

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <vector>

#include "base/paged_vector.h"
#include "imu/sample_facts.h"
#include "state/error_layout.h"

namespace hindsight {

/// One line of an IMU file in body axes forward-right-down.
struct ImuSample {
  double t = 0.0;  ///< [s] since the data set's epoch
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();   ///< [rad/s] or [rad]
  Eigen::Vector3d accel = Eigen::Vector3d::Zero();  ///< [m/s^2] or [m/s]
};

/// White noise and bias instability of an IMU. Densities are one-sided in the
/// navigation sense: the variance of the integral grows by density^2 dt.
struct ImuNoise {
  double gyro_noise_density = 0.0;   ///< [rad/s/sqrt(Hz)] = [rad/sqrt(s)]
  double accel_noise_density = 0.0;  ///< [m/s^2/sqrt(Hz)]
  double gyro_bias_walk = 0.0;       ///< [rad/s/sqrt(s)], 0: constant bias
  double accel_bias_walk = 0.0;      ///< [m/s^2/sqrt(s)], 0: constant bias
  /// Correlation times [s]; infinity makes the bias a walk or a constant. With
  /// a finite time the walk is the driving density, sqrt(2/tau) sigma.
  double gyro_bias_tau = std::numeric_limits<double>::infinity();
  double accel_bias_tau = std::numeric_limits<double>::infinity();
  /// Gyro noise that grows with rate: density^2 += (factor |w|)^2 [sqrt(s)].
  double gyro_noise_per_rate = 0.0;

  Evolution GyroBiasEvolution() const;
  Evolution AccelBiasEvolution() const;
};

/// The IMU's record. Rates are instantaneous values at the stamps, taken as
/// linear in between; increments are integrals over the interval that ends at
/// the stamp (the first sample is where the second's interval begins).
struct ImuStream {
  enum class Kind { kRates, kIncrements };
  Kind kind = Kind::kRates;
  PagedVector<ImuSample> samples;  ///< strictly increasing stamps
  ImuNoise noise;
  /// Sample intervals longer than this are refused on reading [s].
  double max_gap = 0.5;
  /// What reading added to the stamps of the file [s]; a negative one says that
  /// the readings are late. Attitude-only solutions are given at the file's own
  /// stamps.
  double stamp_offset = 0.0;
  /// The usual sample interval, 0 if not known [s]. An interval of more than
  /// kGapFactor times this is a drop-out: bridged by the straight line between
  /// the readings on both sides, with noise that allows for what may have
  /// happened meanwhile (see BridgeNoise).
  double nominal_dt = 0.0;
  static constexpr double kGapFactor = 3.5;
  /// What was found of the samples.
  SampleFactsMemo facts = {};

  /// Whether an interval of this length [s] is a drop-out.
  bool IsDropOut(double interval) const {
    return nominal_dt > 0.0 && interval > kGapFactor * nominal_dt;
  }
  bool empty() const { return samples.size() < 2; }
  /// First and last time at which the motion is known [s].
  double t_begin() const { return samples.front().t; }
  double t_end() const { return samples.back().t; }
};

/// Median sample interval [s].
double MedianInterval(const ImuStream& stream);
/// nominal_dt, or the median where that is not known [s].
double UsualInterval(const ImuStream& stream);

/// The drop-outs of a stream with a known nominal_dt: the sample numbers at
/// their ends.
std::vector<std::size_t> DropOuts(const ImuStream& stream);

}  // namespace hindsight

#endif  // HINDSIGHT_IMU_IMU_STREAM_H_
