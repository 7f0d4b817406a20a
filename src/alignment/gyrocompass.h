#ifndef HINDSIGHT_ALIGNMENT_GYROCOMPASS_H_
#define HINDSIGHT_ALIGNMENT_GYROCOMPASS_H_

#include "alignment/alignment.h"

namespace hindsight {

/// Method `gyrocompass`: LevelAttitude at rest, and as heading the direction in
/// which the levelled mean rate has no east component,
///   heading = atan2(-w_y, w_x),   w = C_level (mean rate - b_g).
/// With the Earth's rate (W_N, 0, W_D) in NED the heading error is
///   psi_D = ((C_nb db_g)_E + psi_N W_D + noise) / W_N,
/// noise = density / sqrt(T) (Groves, Principles of GNSS, Inertial and
/// Multisensor Integrated Navigation Systems, 5.6.2). P and P_bias follow. A
/// sigma above 20 deg counts as no heading.
AlignmentOutcome AlignByGyrocompass(const AlignmentInput& input);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_GYROCOMPASS_H_
