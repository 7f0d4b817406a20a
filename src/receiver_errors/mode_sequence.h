#ifndef HINDSIGHT_RECEIVER_ERRORS_MODE_SEQUENCE_H_
#define HINDSIGHT_RECEIVER_ERRORS_MODE_SEQUENCE_H_

#include <vector>

#include "receiver_errors/onset.h"
#include "receiver_errors/sensor_tape.h"

namespace hindsight {

/// What a position receiver's error is at a fix, beyond white noise.
enum class ErrorMode : char {
  kGood,      ///< none
  kBiased,    ///< e, a Gauss-Markov process
  kDrifting,  ///< e grows at a rate r that hardly changes
  kSlight     ///< as kBiased, but for a smaller sigma
};

/// How the error came to a fix from the one before it. `anew`: of a bias, e is
/// drawn anew (a jump); of a drift, r is. A bias that is not new goes on, or
/// follows a drift that stops. `velocity_step`: what goes on does so over an interval in
/// which the velocity that the IMU integrates has a step that no noise explains
/// (a shock beyond its range, lost samples), which else would pass for a drift of
/// the receiver. `outlier`: the fix is one whatever the likelihood says of it at its
/// time: where the state is known badly, as behind a gap, only later fixes tell. `onset`:
/// when a new drift, or the velocity step, began; usual of all else. A drift and a step
/// begin alike: else the one would stand for the other.
struct ErrorStep {
  ErrorMode mode = ErrorMode::kGood;
  bool anew = false;
  bool velocity_step = false;
  bool outlier = false;
  Onset onset = Onset::kUsual;
  bool operator==(const ErrorStep&) const = default;
};

/// A step for each node that has a fix of the receiver, in order.
using ModeSequence = std::vector<ErrorStep>;

/// Whether it has no error of the receiver, whatever steps the IMU's velocity has.
bool IsGoodThroughout(const ModeSequence& sequence);

/// Whether it has an onset: of a new drift, or a velocity step.
bool BeginsAtSomeTime(ErrorStep step);
ErrorStep WithoutVelocityStep(ErrorStep step);

/// The modes of a sequence in their order, whatever their change points.
std::vector<ErrorMode> ModeOrder(const ModeSequence& sequence);

struct ErrorParameters {
  double scale = 1.0;           ///< on the stated sigma of a fix
  double outlier_share = 0.02;  ///< of the fixes
  double outlier_ratio = 10.0;  ///< sigma of an outlier, by that of others
  double sigma = 10.0;          ///< of a bias, an axis [m]
  double tau = 1000.0;          ///< its correlation time [s]
  /// Sigma of a bias down (the third row of a fix), by that of the others: satellites
  /// are above, and a wall reflects sideways.
  double down = 1.0;
  double slight_sigma = 2.0;  ///< of a slight bias: receivers have both
  double slight_tau = 100.0;  ///< its correlation time [s]
  double rate_sigma =
      0.1;  ///< of a drift, and of a velocity step, an axis [m/s]
  double imu_scale = 1.0;  ///< on the stated noise of the IMU
};

/// How often a bias or drift ends, and the receiver is good again, in a recording
/// that would be all bias or drift: the expectation a priori.
inline constexpr double kEndsOfAnError = 4.0;

/// ln probability of a step after a mode, over an interval that is `share` of a
/// recording, which is expected to hold a few changes: of a Markov chain in continuous
/// time with one change an interval at most. An outlier has its own in its likelihood.
double LogTransition(ErrorMode before, ErrorStep step, double share);
/// ln probability of the step at the first fix: good or slightly biased in eleven
/// of twelve recordings, else biased or drifting; within each of the two as in
/// the stationary distribution of the transitions. `share`, of the interval before it, counts
/// where the velocity of the IMU jumps.
double LogFirst(ErrorStep step, double share);
/// ln of how much likelier it is that a receiver which errs over some stretch does so
/// at the end of a recording than at its begin: 0 of a stationary sequence.
double LogOddsOfBeginningWell();
/// ln of how much likelier it is that a biased receiver jumps to another bias at some
/// time than that a good one becomes biased.
double LogOddsOfAnotherBias();
/// ln of what `count` velocity steps in a sequence cost beyond their transitions.
/// Each is taken as a hundred times rarer than the one before it: an IMU may have
/// had a shock; one that has them again and again is one with other noise than
/// stated (ErrorParameters::imu_scale).
double LogOfVelocitySteps(int count);
int CountVelocitySteps(const ModeSequence& sequence);
/// The steps that may follow a mode.
std::vector<ErrorStep> StepsAfter(ErrorMode before);

/// The steps into every node: those of the sequence at fixes, between them what
/// goes on.
std::vector<ErrorStep> StepsByNode(const SensorTape& tape,
                                   const ModeSequence& sequence);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_MODE_SEQUENCE_H_
