#ifndef HINDSIGHT_IMU_MEAN_READING_H_
#define HINDSIGHT_IMU_MEAN_READING_H_

#include <vector>

#include "imu/imu_stream.h"
#include "imu/kinematics.h"
#include "imu/preintegration.h"

namespace hindsight {

/// Mean reading over [begin, end], biases not removed: over the sample
/// intervals [t_k-1, t_k] of which both stamps lie in it, to 1 us,
///   sum_k dt_k m_k / sum_k dt_k,
/// with m_k the mean of the two readings of rates and the increment over dt_k
/// of increments (of one that bridges a drop-out, what ImuIntegrator takes).
/// An interval that only reaches into the span is none of it: what happens
/// beside the span stays outside. A span that holds no interval has the mean of
/// the one at its middle. The stream has two samples at least.
Kinematics MeanReading(const ImuStream& imu, double begin, double end);

/// Mean readings about ascending times, each from half way to the time before
/// to half way to the next.
std::vector<Kinematics> MeanReadings(const ImuStream& imu,
                                     const std::vector<double>& times);

/// Without the errors of a calibration: (m - b) / (1 + s).
Kinematics WithoutErrors(Kinematics mean, const ImuCalibration& calibration);

}  // namespace hindsight

#endif  // HINDSIGHT_IMU_MEAN_READING_H_
