#ifndef HINDSIGHT_PROBLEMS_ATTITUDE_TRIAL_H_
#define HINDSIGHT_PROBLEMS_ATTITUDE_TRIAL_H_

#include <string>
#include <vector>

#include "problems/montecarlo.h"

namespace hindsight {

/// A rule of the accelerometer (AhrsSettings) and the methods that are tried with
/// it.
struct TriedRule {
  std::string name;
  std::string rule;
  double gate = 0.88;  ///< [m/s^2]
  std::vector<std::string> methods = {"ahrs"};
};

/// Fixed; gates at 0.3, 0.88 and 3 m/s^2; the gate at 0.88 m/s^2 held for N = 4
/// samples; adaptive and SMNC at equal lambda (N + 1) = 0.25; with gate 0.88 and
/// SMNC the RTS smoothers too.
std::vector<TriedRule> TriedRules();

/// The recordings of attitude alone under a rule, measured by VibrationTable at
/// every sample; the rule's name is the last of its labels.
Case VibrationCase(std::vector<std::string> labels, const Recording& recording,
                   const TriedRule& rule);

/// Of the recordings of Kim and Leeghim (2016), over all runs and samples of an
/// interval (_0_5s, _5_10s, _10_40s, _40_45s, _45_60s and _10_60s): rms_total_ of
/// |psi| [rad]; inside_, the share of its components within 3 sigma; bias_rms_,
/// of an axis of the gyro bias [rad/s].
StudyTable VibrationTable();

/// Of recordings that move from `begin` to `end` [s]: heading_rms and tilt_rms
/// [rad] of the motion; nees of the attitude in its middle, mean over the runs,
/// where 3 is right; inside, the share of the motion's samples within the
/// ellipsoid that holds 99.73 %.
StudyTable RotationTable(double begin, double end);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_ATTITUDE_TRIAL_H_
