#ifndef HINDSIGHT_PROBLEMS_VIBRATION_COMPARISON_H_
#define HINDSIGHT_PROBLEMS_VIBRATION_COMPARISON_H_

#include <Eigen/Core>
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "dataset/dataset.h"

namespace hindsight {

/// One row of the comparison: an accelerometer rule with its parameters, or its
/// smoother.
struct VibrationRow {
  std::string name;  ///< "smnc", "gate 0.88", ...
  AhrsSettings ahrs;
  bool smoothed = false;
};

/// fixed; gates at 0.3, 0.88 and 3 m/s^2; the gate at 0.88 m/s^2 held for N = 4
/// samples; adaptive and SMNC at equal lambda (N + 1) = 0.25; the RTS smoothers
/// of gate 0.88 and SMNC.
std::vector<VibrationRow> VibrationRows();

/// Time span of a statistic, [begin, end) [s].
struct VibrationInterval {
  double begin = 0.0;
  double end = 0.0;
};
/// 0-5, 5-10, 10-40, 40-45, 45-60 s and all after 10 s.
const std::vector<VibrationInterval>& VibrationIntervals();

/// Errors psi (truth from estimate, NED) over all runs and samples of an
/// interval.
struct VibrationStatistics {
  Eigen::Vector3d rms = Eigen::Vector3d::Zero();      ///< an axis [rad]
  Eigen::Vector3d largest = Eigen::Vector3d::Zero();  ///< an axis [rad]
  double rms_total = 0.0;                             ///< of |psi| [rad]
  double bias_rms = 0.0;     ///< of the gyro bias, an axis [rad/s]
  double inside = 0.0;       ///< share of psi's components within 3 sigma
  double bias_inside = 0.0;  ///< share of the gyro bias's within 3 sigma
};

struct VibrationResult {
  std::string name;
  std::vector<VibrationStatistics> intervals;  ///< as VibrationIntervals()
};

/// Every row on the same `runs` realisations of `simulate`, a data set of a
/// seed with truth at every sample. `done` is called after each run.
std::vector<VibrationResult> CompareUnderVibration(
    const std::function<Dataset(std::uint64_t)>& simulate, int runs,
    std::uint64_t first_seed, const std::function<void(int)>& done,
    const std::atomic<bool>* stop);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_VIBRATION_COMPARISON_H_
