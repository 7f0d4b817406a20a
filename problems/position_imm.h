#ifndef HINDSIGHT_PROBLEMS_POSITION_IMM_H_
#define HINDSIGHT_PROBLEMS_POSITION_IMM_H_

#include <vector>

#include "alignment/start.h"
#include "filters/imm.h"

namespace hindsight {

/// The multiple-model filter of Baek (2019): INS errors without the vertical
/// ones (16: horizontal position and velocity, attitude, gyro and accelerometer
/// biases, accelerometer scale factors), the satellite receiver's horizontal
/// error as two coloured states, feed-forward, positions alone.
///
/// The shaping filter, eqs. (12) and (13) there, prints
///   v_k = (1 - beta T) v_k-1 + A sqrt(2 beta) T w*_k-1.
/// With beta = 10 and T = 1 s the factor 1 - beta T is -9 and the error would
/// grow without bound, and the noise of a continuous w* over T lacks 1/T in the
/// variance: the term should read sqrt(T). Both are first orders in beta T of
///   phi = exp(-beta T),   q = A^2 (1 - phi^2),
/// which is what stands here: a stationary error of standard deviation A.
/// In its eq. (2) the second row should read
///   dl' = rho_N / cos L (tan L - R_tt / (R_t + h)) dL
///         - rho_N / (cos L (R_t + h)) dh + dV_E / ((R_t + h) cos L);
/// here the errors are in metres north and east, and need neither.
struct PositionImmOptions {
  std::vector<double> amplitudes = {20.0, 1.0};  ///< A of each model [m]
  double beta = 10.0;                            ///< [1/s]
  double stay = 0.9;                             ///< pi_ii, eq. (14)
};

/// The filter's models over the 18 states, from a data set's start. Its first
/// position stream is the receiver.
std::vector<ImmModel> PositionImmModels(const Dataset& dataset,
                                        const Start& start,
                                        const PositionImmOptions& options);

/// Runs it; with one amplitude it is the single filter of that amplitude.
/// Throws InputError without a position and a height stream.
ImmResult RunPositionImm(const Dataset& dataset, const Start& start,
                         const PositionImmOptions& options, Timeline* timeline);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_POSITION_IMM_H_
