#ifndef HINDSIGHT_RECEIVER_ERRORS_RECEIVER_ERRORS_H_
#define HINDSIGHT_RECEIVER_ERRORS_RECEIVER_ERRORS_H_

#include <Eigen/Core>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "filters/linear_tape.h"
#include "receiver_errors/told_velocity_step.h"
#include "state/evidence.h"
#include "state/solution.h"
#include "timeline/problem.h"

namespace hindsight {

struct ErrorDecisions;  // receiver_errors/sensor_findings.h
struct SensorFindings;  // receiver_errors/sensor_findings.h

/// What a search decided, by sensor.
using DecidedErrors = std::vector<std::shared_ptr<const ErrorDecisions>>;

/// The sensor that decisions are about.
std::size_t SensorOf(const ErrorDecisions& decisions);

/// Whether a layout holds so many more states of errors of sensors.
bool HasRoomFor(const ErrorLayout& layout, int states);

/// Whether noise was chosen, but does not rule out a Gauss-Markov error throughout.
bool HasOpenBias(const ErrorDecisions& decisions);

/// That error in words, which HasOpenBias: "gnss: covariances hold it to 40 % that ...".
std::string OpenBiasInWords(const ErrorDecisions& decisions);

/// Gives a problem that error, if the sensor has no other there: a block behind all others,
/// so large and slow as is expected a posteriori. Returns its probability, 0 if nothing was
/// done. `tape` has the nodes of the problem.
double ExtendByOpenBias(const ErrorDecisions& decisions, const LinearTape& tape,
                        Problem* problem);

/// What is asked of FindReceiverErrors.
struct ErrorQuestion {
  /// Sensors that are not looked at: what was found of them is in the problem.
  std::vector<int> known = {};
  /// Of a search about another tape: taken as it is, where the nodes hold the
  /// same fixes, instead of a search. nullptr: none.
  const DecidedErrors* decided = nullptr;
  /// What searches about other tapes have met: of a sensor of which the nodes hold as many
  /// fixes a search begins from the likeliest of it as well, without steps of the IMU's
  /// velocity.
  DecidedErrors met = {};
  /// Asks after sensors of velocities in the axes of the vehicle (odometers, DVLs, and
  /// that wheels do not slip sideways) in place of the absolute ones.
  bool in_vehicle_axes = false;
  /// Of the effort that a search may cost.
  double share = 1.0;
  /// Told the fraction done, between the steps of the search, by one thread at a time;
  /// false ends it with the best so far; may throw to abandon it.
  std::function<bool(double)> go_on = nullptr;
  /// When it ends in any case. The sensors share the time, as they are compared; where
  /// that is too short for the parameters of several, none of these is blamed.
  std::chrono::steady_clock::time_point until =
      std::chrono::steady_clock::time_point::max();
};

class ReceiverErrors;

/// Another sensor's errors, which explain the data in place of one's own.
struct RivalSensor {
  const ReceiverErrors* errors;
  double probability;
};

/// What the errors of one absolute sensor are like, as FindReceiverErrors found
/// them: the noise of its fixes, and beyond noise the hypotheses of its error
/// that the data do not rule out, of which one is chosen.
class ReceiverErrors {
 public:
  /// Whether what was found stands against the noise as stated: it wins by odds
  /// of a thousand on evidence and does not lose on held-out stretches. If not,
  /// the problem is best solved as it is, and only Notes and `doubts` say
  /// anything.
  bool Stands() const;

  /// Whether the search for them was ended by whoever asked.
  bool WasEnded() const;
  /// Whether that was before any of its parameters were fitted.
  bool IsUnfitted() const;

  int sensor() const;
  std::string name() const;
  /// ln of its evidence over that of the noise as stated, at all fixes of the tape; 0
  /// unless it stands.
  double log_gain() const;

  /// Gives the problem that was asked about what was found: to the sensor's
  /// fixes their sigma, but none smaller than stated, and a two-component mixture
  /// as loss; behind all other
  /// blocks of the layout the sensor's error e [SI, along its rows] and, if it
  /// drifts, its rate, which go from node to node as the chosen hypothesis says
  /// (Timeline::SetBlockSteps). White errors bring no blocks.
  void Extend(Problem* problem) const;

  /// Gives a problem that was extended by it a Gauss-Markov error so large and slow as
  /// is expected a posteriori, for covariances: the trajectory is told by what is
  /// likelier, and smaller. False, and nothing done, of other errors.
  bool Expect(Problem* problem) const;

  /// The smoothed trajectory of the chosen hypothesis, a state a node, over the
  /// layout of the extended problem.
  std::vector<State> States(const ErrorLayout& layout) const;

  /// Adds to the covariances of the chosen hypothesis's solution, a node each,
  /// how far the other hypotheses take the trajectory elsewhere, weighed by their
  /// probabilities. Where those that lead elsewhere are together likelier than one
  /// to 10^(1/2), what Jeffreys (Theory of Probability, 1961) calls odds hardly
  /// worth mentioning, the states become the mean of all, which is nearest to the
  /// truth in the mean square. What is doubtful is returned where such others are
  /// more than three stated sigmas of a fix away, or where the widened covariances
  /// do not hold less likely ones (FindRivalBeyond) to odds of a thousand.
  std::optional<Evidence> Average(const ErrorLayout& layout,
                                  std::vector<State>* states,
                                  CovarianceSeries* P) const;

  /// The sizes of its errors, for words, as a solution of the extended problem has
  /// them, a state a node, in place of the chosen hypothesis's: the search is linear
  /// about another trajectory.
  void TakeSizes(const ErrorLayout& layout, const std::vector<State>& states);

  /// What was found, in words; `P` as it was before Average.
  std::vector<std::string> Notes(const CovarianceSeries& P) const;

  /// What makes the result doubtful: the only sensor of positions erring to its
  /// last fix, or from its first, for more than an eighth of the recording; the only
  /// other one off in its place, where they agree nowhere; an IMU whose noise has to be
  /// taken for much more than stated, or for much less while its velocity steps. It is
  /// one IMU: `imu_scale` is the least factor on its noise that was found beside errors
  /// of other sensors.
  std::vector<Evidence> Doubts(double imu_scale = 1.0) const;
  /// The factor on the noise of the IMU beside the errors, which stand.
  double imu_scale() const;

  /// What makes the result doubtful beside noise that was chosen: errors that lose to
  /// it, or win, by odds of less than a thousand, and would make the mean NEES of the
  /// horizontal position more than 25 by covariances P, a node each (errors of the
  /// horizontal position first); of odds hardly worth mentioning, or that win, errors
  /// that lead elsewhere as in Average.
  std::optional<Evidence> DoubtOfNoise(const CovarianceSeries& P) const;
  bool IsUndecided() const;

  /// How probable it is, by node, that the sensor is good, biased, drifting or
  /// slightly biased.
  ModePart Modes() const;

  /// By node, the probability that a fix is taken at its word: that it is good,
  /// where the sensor is not so throughout; else 1.
  std::vector<double> Trust() const;

  /// Parameters of the likeliest hypothesis that were sought within bounds. None
  /// is at one before the noise is fitted to all fixes again.
  std::vector<BoundedValue> Bounded() const;

  /// Mean square of the horizontal distance from the trajectory of another
  /// sensor's errors, both of which stand [m^2].
  double MeanSquareDistanceTo(const ReceiverErrors& other) const;
  /// Whether that trajectory is more than three standard deviations of P (errors
  /// of the horizontal position first) away at some node.
  bool IsApart(const ReceiverErrors& other, const CovarianceSeries& P) const;
  /// Adds to P what it is worth that one of the others errs in place of this sensor, by
  /// the covariance of all alike. Where together they are likelier than one to 10^(1/2)
  /// and `states` is not null, these become the mean of all, weighed by their
  /// probabilities, P is of the mixture, and true is returned.
  bool AverageWith(const std::vector<RivalSensor>& others,
                   const ErrorLayout& layout, std::vector<State>* states,
                   CovarianceSeries* P) const;
  /// ln of what sequence and parameters of the likeliest hypothesis are worth a
  /// priori: of its evidence without the likelihood.
  double LogOfPrior() const;
  /// Whether the velocity of the IMU steps in the chosen hypothesis.
  bool HasVelocitySteps() const;
  /// These, each at any time at which nothing would have seen it, whatever its onset: by
  /// that of the search, which is linear about a trajectory that has the step as something
  /// else, states between nodes would be told too well.
  std::vector<ToldVelocityStep> VelocitySteps() const;
  /// Times of the nodes at which the sensor's errors begin, end or change in the
  /// chosen hypothesis.
  std::vector<double> ChangeTimes() const;
  /// Of how many fixes, or normal points, sequences were sought.
  double searched_fixes() const;
  /// What was decided, for ErrorQuestion::decided.
  std::shared_ptr<const ErrorDecisions> Decisions() const;
  /// The chosen hypothesis in words: "gnss: biased from 120 to 140 s by 8.2 m".
  std::string InWords() const;

 private:
  explicit ReceiverErrors(std::shared_ptr<const SensorFindings> found);
  friend std::vector<ReceiverErrors> FindReceiverErrors(
      const Problem& problem, const LinearTape& tape,
      const ErrorQuestion& question);

  std::shared_ptr<const SensorFindings> found_;  ///< common to copies
  std::vector<double> sizes_;  ///< of the error, by node, if any stands
};

/// Two ways to explain the data, the other of which has a probability and is up to so
/// many metres away; these come first, as lines have room for little.
std::string DescribeEither(const std::string& chosen, const std::string& other,
                           double probability, double distance);

/// Finds out from the data alone what the errors of the absolute sensors are
/// like, each by itself, the others being taken at their word: white,
/// Gauss-Markov, or good at times and at others biased or drifting; each with
/// outliers (docs/receiver_errors.md). Absolute is what tells a position, a
/// velocity over the ground, a height, a course or a heading by itself, with a
/// used measurement on the tape, of at most three rows; or what ErrorQuestion::in_vehicle_axes
/// names. What has gained the most
/// evidence comes first; of equals, positions.
///
/// `tape` is the problem linearised about one fixed trajectory and must outlive
/// what is returned. If the layout has a Gauss-Markov error of a sensor already,
/// only white errors are fitted. The time is linear in the number of nodes.
/// Throws EstimationError if the noise of a measurement is not positive
/// definite.
std::vector<ReceiverErrors> FindReceiverErrors(
    const Problem& problem, const LinearTape& tape,
    const ErrorQuestion& question = {});

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_RECEIVER_ERRORS_H_
