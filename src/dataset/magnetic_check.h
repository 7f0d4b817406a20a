#ifndef HINDSIGHT_DATASET_MAGNETIC_CHECK_H_
#define HINDSIGHT_DATASET_MAGNETIC_CHECK_H_

#include <optional>
#include <string>
#include <vector>

#include "dataset/dataset.h"

namespace hindsight {

/// Where the recording is, roughly: the given position or place, else the
/// first position fix; absent if nothing says.
std::optional<Eigen::Vector3d> RoughPosition(const Dataset& dataset);

/// What is wrong with a mean field, hard iron removed, in levelled axes (z
/// down) [uT] at p_e; empty if nothing is:
///   - its norm is more than twice what the Earth's field can have, or less
///     than half;
///   - it points up where it should point down, or the other way: its dip and
///     that of the dipole field have different signs and sines above 0.3.
std::string FieldContradiction(const Eigen::Vector3d& field_level,
                               const Eigen::Vector3d& p_e);

/// One line for each thing that looks wrong with the magnetometers: a norm
/// outside 22 to 67 uT (and what the unit may be); axes whose sign or order
/// makes the field turn against the gyros, or point up in the northern or down
/// in the southern magnetic hemisphere; a configured `down` of the wrong sign.
/// They are found over windows of 10 s: all 48 arrangements are compared by
///   chi2 = n log(T + 0.02^2) + (s - s_0)^2 / 0.35^2 + changed axes,
/// T the squared scatter of the field, carried to the begin of the window by
/// the gyros, over its squared norm, in the n windows (20 count) in which the
/// body turns by 20 deg and more; s and s_0 the sines of its dip against
/// gravity and of the dipole's. They count as changed where that lowers chi2 by
/// more than 9, and T to a quarter or the dip has the wrong sign.
std::vector<std::string> CheckMagnetometers(const Dataset& dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_MAGNETIC_CHECK_H_
