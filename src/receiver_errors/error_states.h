#ifndef HINDSIGHT_RECEIVER_ERRORS_ERROR_STATES_H_
#define HINDSIGHT_RECEIVER_ERRORS_ERROR_STATES_H_

#include <string>
#include <vector>

#include "receiver_errors/error_regimes.h"
#include "receiver_errors/told_velocity_step.h"
#include "receiver_errors/weighed_hypotheses.h"
#include "state/block_step.h"
#include "timeline/problem.h"

namespace hindsight {

/// The error (e, r) of a sensor, as one hypothesis has it, as states of a
/// problem: e is a block kSensorError, r a block kErrorRate, with as many axes
/// as the sensor's measurements have rows.
class ErrorStates {
 public:
  /// All arguments must outlive the object.
  ErrorStates(const LinearTape& tape, int receiver, double stated_sigma,
              const std::string& unit, ErrorRegimes::Kind kind,
              const WeighedHypothesis& chosen);

  /// Puts e and r behind all other blocks, as far as the hypothesis has them, with
  /// their steps; gives the sensor's fixes the sigma and loss as found.
  void Extend(Problem* problem) const;

  /// The first of both alone.
  void AddError(Problem* problem) const;

  /// In a problem that was extended so, gives e the sigmas and the correlation time of
  /// `other`.
  void Replace(const ErrorParameters& other, Problem* problem) const;

  /// The steps of the IMU's velocity, each at any time at which nothing would have seen it.
  std::vector<ToldVelocityStep> VelocitySteps() const;

  /// The smoothed trajectory of the hypothesis, over the extended layout.
  std::vector<State> States(const ErrorLayout& layout) const;

  /// A state of the extended problem, moved by an error as SmoothSequence has
  /// it.
  State Moved(const ErrorLayout& layout, const State& x,
              const ErrorVector& by) const;

 private:
  bool HasError() const { return kind_ > ErrorRegimes::Kind::kWhite; }
  bool HasRate() const;
  void ApplyToSensor(Timeline* timeline) const;
  void AddBlock(BlockKind kind, const std::string& name,
                const std::string& unit, const Eigen::Vector3d& sigma0,
                ErrorLayout* layout) const;
  /// Over the interval into node k. Where e does not drift r is drawn anew, so
  /// that it is free where a drift begins.
  std::vector<BlockStep> StepsTo(std::size_t k,
                                 const ErrorParameters& parameters) const;

  const LinearTape& tape_;
  int receiver_;
  int rows_;                        ///< of the sensor's measurements
  std::vector<UnseenTime> unseen_;  ///< by node, of a drift
  double floor_;                    ///< sigma of e where the sensor is good
  std::string unit_;
  ErrorRegimes::Kind kind_;
  const WeighedHypothesis& chosen_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_ERROR_STATES_H_
