#ifndef HINDSIGHT_PROBLEMS_PAPERS_VIBRATION_COMPARISON_H_
#define HINDSIGHT_PROBLEMS_PAPERS_VIBRATION_COMPARISON_H_

#include "problems/montecarlo.h"

namespace hindsight {

/// The accelerometer rules of attitude-only estimation on recordings with
/// truth at every sample: fixed; gates at 0.3, 0.88 and 3 m/s^2; the gate at 0.88
/// m/s^2 held for N = 4 samples; adaptive and SMNC at equal lambda (N + 1) =
/// 0.25; the RTS smoothers of gate 0.88 and SMNC.
///
/// Figures, in columns disturbance and rule, of psi (truth from estimate, NED)
/// over all runs and samples of an interval (_0_5s, _5_10s, _10_40s, _40_45s,
/// _45_60s and _10_60s): rms_ and max_, an axis [rad], rms_total_ of |psi|,
/// inside_ the share of the components within 3 sigma; of the gyro bias
/// bias_rms_, an axis [rad/s], and bias_inside_.
Trial VibrationTrial();
StudyTable VibrationTable();

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_PAPERS_VIBRATION_COMPARISON_H_
