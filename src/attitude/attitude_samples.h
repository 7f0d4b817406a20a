#ifndef HINDSIGHT_ATTITUDE_ATTITUDE_SAMPLES_H_
#define HINDSIGHT_ATTITUDE_ATTITUDE_SAMPLES_H_

#include <vector>

#include "attitude/inertial_low_pass.h"
#include "imu/imu_stream.h"
#include "state/solution.h"

namespace hindsight {

/// Attitudes at other times: the state at the sample before, turned by the rate
/// of that sample. Nothing later enters, so a causal solution stays causal.
Solution SampleAttitude(const Solution& solution, const ImuStream& imu,
                        const std::vector<double>& times);

/// Specific force of every sample in body axes, low-passed forwards and backwards
/// with `tau` [s] in axes that do not turn (IFLP, Laidig and Seel 2023): what a hand
/// accelerates falls out, gravity stays, and nothing lags. A swing whose period
/// is not short against tau does not fall out: its acceleration goes with the
/// angle, as the error of a scale factor does. `q_nb` is the attitude at every
/// sample.
std::vector<BiasedForce> AveragedForce(
    const ImuStream& imu, const std::vector<Eigen::Quaterniond>& q_nb,
    double tau);

}  // namespace hindsight

#endif  // HINDSIGHT_ATTITUDE_ATTITUDE_SAMPLES_H_
