#ifndef HINDSIGHT_DATASET_FROZEN_IMU_H_
#define HINDSIGHT_DATASET_FROZEN_IMU_H_

#include <vector>

#include "imu/imu_stream.h"

namespace hindsight {

/// Readings in a row that are equal in every digit.
struct RepeatedRun {
  double t_begin = 0.0;
  double t_end = 0.0;
  long rows = 0;
  const char* channel = "";  ///< of an IMU: "gyro z"; empty: all that is read
};

/// Shorter runs are a rate below that of the rows, not a sensor that hangs [s].
inline constexpr double kLeastFrozen = 0.1;

/// Readings so many steps of their resolution apart are not equal by rounding.
inline constexpr double kStepsOfResolution = 4.0;

/// Whether a run of `length` equal rows may have come up by chance. `rows` has
/// the lengths of all runs of two rows and more, ascending. Those shorter than
/// half of `length` tell the probability that a run goes on by another row, and
/// from it follows that of a run of this length. This holds where the noise is
/// at least a fifth of a step of the resolution.
bool IsByChance(const std::vector<long>& rows, long length);

/// Runs of an IMU's samples too long for its resolution. Coarse readings repeat
/// as well; each repetition is then followed by another with a probability that
/// the shorter runs of the stream tell, and a run that had a chance of less
/// than one in a million of coming up anywhere is none of these. At least 0.1 s
/// long.
///   The three gyros, the three accelerometers and each axis are judged by
/// themselves in the same way, where their readings change by more than four
/// steps of their resolution from row to row and lie as far from the repeated
/// one just before and after the run, while another axis of the triad (of a
/// whole triad: of the other) goes on changing from row to row by half of its
/// usual or more: a coarse axis at rest is not frozen. An axis that never
/// changes is dead if white noise makes most of what both others of its triad
/// change from row to row, and else not judged: two axes may have no sensor. A
/// mounting other than by right angles mixes the axes,
/// of which then none is seen to freeze alone.
std::vector<RepeatedRun> FindFrozenImu(const ImuStream& imu);

/// As StaleShare (dataset/repeated_readings.h), of an IMU's samples as a whole.
double StaleImuShare(const ImuStream& imu);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_FROZEN_IMU_H_
