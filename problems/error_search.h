#ifndef HINDSIGHT_PROBLEMS_ERROR_SEARCH_H_
#define HINDSIGHT_PROBLEMS_ERROR_SEARCH_H_

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "problems/robust_batch.h"

namespace hindsight {

/// A sensor that measures velocities over the ground as satellite receivers do.
bool IsOfVelocity(const SensorKind& kind);

/// One way to explain the data by errors of sensors: the problem is extended by
/// them, one after the other (docs/receiver_errors.md, "Search").
class ErrorSearch {
 public:
  /// `options` must outlive the object. `share`: of the effort of a search that
  /// the first search may cost; each further one half of it.
  ErrorSearch(Problem problem, const RobustBatchOptions& options, double share);

  /// Searches begin from what another has met as well.
  void BeginFrom(const SearchDecisions& other);

  /// Each sensor is searched with the others taken at their word, about `initial`,
  /// a state a node; then the rest about what stands, three times at most.
  void Run(const std::vector<State>& initial);

  /// Velocities are searched first, without the positions, which may err as they
  /// do; then the rest about what was found of them. False if nothing was.
  bool RunFromVelocities(const std::vector<State>& initial);

  /// A sensor is searched first, without others that may err as well; then the rest
  /// about what was found of it. False if nothing was.
  bool RunFromOne(int sensor, const std::vector<int>& without,
                  const std::vector<State>& initial);

  /// Odometers, DVLs and constraints of wheels among `suspects` are searched first, the
  /// absolute sensors taken at their word; then these about what was found. False if
  /// nothing was.
  bool RunFromVehicle(const std::vector<int>& suspects,
                      const std::vector<State>& initial);

  /// What RobustBatchOptions::last names, which is left out before, is searched,
  /// the others taken at their word or as they were found; then the rest as by Run.
  void RunLast(const std::vector<State>& initial);

  /// As RobustBatchOptions::decisions say, in the order in which they were found.
  void RunAsDecided(const std::vector<State>& initial);

  /// Nothing stands of `words`, what was found, as `why` says: there is no further round
  /// but of RunLast, for what was left out.
  void Disbelieve(const std::string& words, const std::string& why);

  /// Begins no further search.
  void End() { ended_ = true; }
  /// Whether it does not, as one was ended by whoever asked, or by End.
  bool ended() const { return ended_; }

  /// Whether velocities and positions of a receiver may err together in what was
  /// told otherwise: by steps of the IMU's velocity, by errors that are doubtful
  /// by themselves, or by those of several sensors if any of them come and go.
  bool MayBeOfAReceiver() const;

  /// Sensors in the axes of the vehicle that may have erred in place of what was told
  /// otherwise: all, where errors of an absolute sensor stand; else those of which a row
  /// of a measurement is more than five sigmas from what all before have predicted, or
  /// innovations add up to more than chance explains (TestInnovations): what measures a
  /// little too much says so in no single measurement.
  std::vector<int> SuspectsOfVehicle() const;

  /// Beside errors of positions, found first, that are doubtful by themselves or have
  /// steps of the IMU's velocity: sensors of heights, headings or fields of which errors
  /// stand, at some round. The positions were searched with these at their word, and may
  /// have been given what is theirs. Not of others of positions or velocities, without
  /// which errors of the first explain whatever it is.
  std::vector<int> SuspectsBeside() const;

  /// Two and more sensors of positions that may err alike, as the outputs of one receiver do,
  /// or receivers with one base station: of which each, the others taken at their word,
  /// tells steps of the IMU's velocity, the likeliest first; or all, that which tells most
  /// first, where the innovations of all sensors together say that position or velocity
  /// jump. Else none.
  std::vector<int> ReceiversThatMayErrAlike() const;

  /// Whether errors of velocities change where those of positions do, as mode
  /// sequences have them.
  bool HasCoincidences() const { return LogOfCoincidences() > 0.0; }

  /// ln of the prior of what stands.
  double LogOfPrior() const;
  /// ln of the evidence with no steps of the IMU's velocity but CommonSteps and its noise as
  /// stated, as the batch is solved: the likelihood of the innovations about the
  /// trajectory that was found, fixes that a mixture takes for outliers with the
  /// noise that it gives them, and the priors of what was found. Only differences
  /// mean anything. About `initial` if nothing stands.
  double LogEvidence(const std::vector<State>& initial) const;

  /// Extended by what stands.
  const Problem& problem() const { return problem_; }
  /// The trajectory to solve from; none if nothing stands.
  const std::optional<std::vector<State>>& states() const { return states_; }
  /// What stands, in words.
  std::string InWords() const;
  bool HasErrors(int sensor) const;
  /// Of the first round, that with the best explanation; there must be one.
  int first_sensor() const { return rounds_.front().best().sensor(); }
  /// Whether sensors of RobustBatchOptions::last are left out still.
  bool LeavesOut() const { return with_last_.has_value(); }
  bool IsLeftOut(int sensor) const { return LeavesOut() && IsLast(sensor); }
  SearchDecisions Decisions() const;

  /// Sizes of errors, in words, are those of a solution of `problem` from here on, a
  /// state a node.
  void TakeSizes(const std::vector<State>& states);

  /// As `problem`, which may have other decisions, with Gauss-Markov errors as they are
  /// expected for covariances; none if there are no such errors.
  std::optional<Problem> Expected(Problem problem) const;

  /// Adds to P, as solved, what else there may be; fills in the rest of a
  /// result.
  void Tell(RobustBatchResult* result) const;

 private:
  /// Errors found about one tape, which they need.
  struct Round {
    std::shared_ptr<const LinearTape> tape;  ///< common to copies
    std::vector<ReceiverErrors> errors;      ///< one a sensor; the best first
    std::vector<int> without;                ///< as of DecidedRound
    const ReceiverErrors& best() const { return errors.front(); }
  };

  /// A round about what was found so far, or `initial`: sensors of `problem` for which
  /// `is_asked` are searched, unless their errors are known.
  Round Search(Problem* problem, const std::vector<State>& initial,
               const std::function<bool(int sensor)>& is_asked);
  /// Sensors for which `is_asked` are searched first, without others; then the rest.
  /// False if nothing was found.
  bool RunFrom(const std::function<bool(int sensor)>& is_asked,
               std::vector<int> without, const std::vector<State>& initial);
  bool IsLast(int sensor) const;
  /// Whether the next round is decided, and of a sensor that is to be last.
  bool NextIsLast() const;
  /// Whether what stands of a round that was ended is what other sensors' errors look
  /// like, which there was no time to ask for: doubtful by itself, with steps of the
  /// IMU's velocity or with parameters that are not fitted.
  bool LacksOthers(const Round& round) const;
  /// Extends the problem by what stands of a round.
  void Take(Round round);
  /// Steps of the IMU's velocity that the best of a round tells, and all others of it of
  /// which errors stand, at the same time, a sensor of positions among them: it is one
  /// IMU. Where one of them errs itself at that time it is that error which the others
  /// take for such a step. None where one takes back the one before: that is a jump of the
  /// position, by which receivers err, and no IMU.
  std::vector<VelocityStep> CommonSteps(const Round& round) const;
  /// Whether there is another round: as decided, or to be searched.
  bool HasNext() const;
  /// Whether a state can hold the errors of one more sensor.
  bool HasRoom() const;
  /// Prepares the question of the next round.
  void Ask();
  const SensorKind& KindOf(const ReceiverErrors& errors) const;
  /// Times at which the errors of positions that were found change.
  std::vector<double> ChangesOfPositions() const;
  /// ln of how much likelier changes of the errors of velocities are than those of
  /// independent sensors, where errors of positions change at the same time.
  double LogOfCoincidences() const;
  /// `imu_scale` as of ReceiverErrors::Doubts.
  static void TellNotes(const Round& round, double imu_scale,
                        RobustBatchResult* result);
  /// The least factor on the noise of the IMU beside any errors that stand, or 1.
  double LeastImuScale() const;
  /// Steps of the IMU's velocity that the batch has: nothing tells them from sensors that
  /// err alike.
  void TellVelocitySteps(RobustBatchResult* result) const;
  /// Errors that sensors may have which were left their noise.
  void TellUndecided(RobustBatchResult* result) const;
  /// What it is worth that another sensor errs in place of the likeliest.
  enum class Worth { kNothing, kCovariance, kMean };
  /// Errors of other sensors that explain the same.
  static void TellRivals(const Round& round, Worth worth,
                         RobustBatchResult* result);

  Problem problem_;
  const RobustBatchOptions* options_;
  double share_;
  ErrorQuestion question_;
  std::vector<Round> rounds_;
  int searches_ = 0;  ///< begun; each gets half of the effort of the one before
  /// Decisions of the measurements of sensors that are to be last, while these are
  /// left out.
  std::optional<GateDecisions> with_last_;
  std::optional<std::vector<State>> states_;
  bool ended_ = false;
  std::string unbelieved_;  ///< what was found but does not stand, and why
};

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_ERROR_SEARCH_H_
