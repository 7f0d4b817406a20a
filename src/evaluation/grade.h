#ifndef HINDSIGHT_EVALUATION_GRADE_H_
#define HINDSIGHT_EVALUATION_GRADE_H_

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dataset/dataset.h"
#include "evaluation/innovation_test.h"
#include "state/solution.h"

namespace hindsight {

/// Root mean square errors so many times as large as sigma make a result
/// doubtful. That is a systematic error of one sigma beside it, or twice the
/// variance: half of what the covariance should have covered.
inline constexpr double kDoubtfulError = 1.4142135623730951;
/// With a systematic error of three sigmas the truth is outside of the 3-sigma
/// interval half of the time.
inline constexpr double kUnusableBias = 3.0;
/// The root mean square errors that go with it.
inline constexpr double kUnusableError = 3.1622776601683795;

/// Probability that the innovations of a right model lower its grade.
inline constexpr double kFalseAlarms = 0.003;

/// Rivals that are together so likely make a solution doubtful: as rare as what
/// lies beyond three sigmas.
inline constexpr double kDoubtfulRival = 0.0027;

/// What an estimate started from, and how it came about.
struct StartValues {
  State x;
  ErrorMatrix P;  ///< over the solution's layout
  /// What the configuration says; the rest the program chose itself.
  InitialState given;
  std::string position;   ///< in words: "position fix at t = 3.00 s"
  std::string alignment;  ///< name of the method that chose the attitude
};

/// How a solution compares with the whole interval linearised anew about its
/// smoothed trajectory. Of a component of position, velocity or attitude,
///   e^2 = (d^2 + s^2) / sigma^2,
/// d the distance from the new trajectory, s the new standard deviation: the
/// mean square error of the solution, in its own sigma, as the new
/// linearisation has it. It is one where both agree.
struct LinearisationError {
  double largest = 1.0;   ///< e of any component at any epoch
  std::string component;  ///< with the largest e
  double t = 0.0;         ///< at which it has it [s]
  double rms = 1.0;       ///< over the interval, of the worst component
  std::string rms_component;
  /// Of a filter: d is then no error of linearisation but what the future
  /// tells, and scatters as a normal variable does.
  bool causal = false;
  /// Linearised again, the new trajectory stays where it is.
  bool settled = false;
};

struct AgreementFigure;  // evaluation/agreement.h
struct LeftOutSensor;    // evaluation/contradicted_sensor.h
struct Explanation;      // evaluation/explanation.h

/// By what factor the errors of a constant exceed its sigma, as the innovations
/// tell that it is read from; beyond chance, or 1.
struct ConstantExcess {
  std::string name;  ///< as of ConstantEstimate
  double factor = 1.0;
};

/// What the rules look at.
struct Judged {
  const Solution& solution;
  std::span<const Sensor> sensors = {};  ///< empty: residuals are not judged
  std::optional<StartValues> start = std::nullopt;
  std::optional<LinearisationError> linearisation = std::nullopt;
  /// The tests that the next five come from could not be made.
  bool untested = false;
  /// About the solution, of the model that it has of the sensors.
  std::span<const InnovationFigure> innovations = {};
  /// A causal solution that is within kUnusableBias of its sigmas of what its
  /// smoother tells, in the root mean square over the interval, the innovations
  /// of which make it no worse than doubtful: those of a filter that has taken
  /// readings for poor, and says so in its sigma, make it doubtful then as well.
  bool vouched_for = false;
  std::span<const Explanation> explanations = {};
  std::span<const AgreementFigure> agreement = {};
  const LeftOutSensor* contradiction = nullptr;
  std::span<const ConstantExcess> constants = {};
  /// What may have kept a method from its result, in words; empty: nothing.
  std::string hindrance = "";
  /// Sensor whose estimated time offset goes on moving; empty: none.
  std::string unsettled = "";
  /// What the recording shows by itself, of the solution's interval.
  std::vector<Evidence> recording = {};
  /// What the method itself says against its result.
  std::vector<Evidence> doubts = {};
  /// Where it ends elsewhere than another method that minimises the same cost.
  std::optional<Evidence> disagreement = std::nullopt;
  /// Nothing says where north is: the heading counts from the start.
  bool relative_heading = false;
  /// Dataset::mounting_sigma, which no covariance of the solution holds [rad].
  Eigen::Vector3d mounting_sigma = Eigen::Vector3d::Zero();
};

/// One rule: adds what it finds. It sees no truth.
struct GradeRule {
  const char* name;
  void (*find)(const Judged& judged, std::vector<Evidence>* evidence);
};

/// All rules, those first whose evidence explains the others'.
std::span<const GradeRule> GradeRules();

/// Fills `constants`, `unobserved`, `evidence`, `grade` and `verdict` of the
/// solution, which is the one judged. `known` are spans that no method can
/// observe, whatever its own covariances say.
void Conclude(const Judged& judged, const std::vector<UnobservedSpan>& known,
              Solution* solution);

/// Gives a method that failed its grade: no trajectory, for `reason`.
Solution FailedSolution(const std::string& method, const std::string& reason);

/// Has every solution's evidence advise only methods that are better: takes out
/// those that are among the solutions with no better grade, and where the
/// linearisation is at fault adds those that linearise anew and have one.
void AdviseBetterMethods(std::vector<Solution>* solutions);

/// Adds to what speaks against a solution, with the grade and verdict that follow.
void AddEvidence(Evidence evidence, Solution* solution);

/// Tells both methods of every disagreement, which is found when the later one
/// is judged.
void ShareDisagreements(std::vector<Solution>* solutions);

/// What a search for errors of sensors (the rule `search`) is doubtful by holds for all
/// methods that see the whole interval, though they take the sensors at their word: they
/// become doubtful by it, if they are usable. That a search was ended does not make them
/// so; what comparing methods shows of one of them (Solution::compared) does.
void ShareFindings(std::vector<Solution>* solutions);

/// Index of the best of several solutions of one recording: the best grade; of
/// equal ones the least evidence against it; then the order of `preference`,
/// the names of methods, best first. No truth is looked at. -1 if there are
/// none.
int BestOf(const std::vector<Solution>& solutions,
           std::span<const char* const> preference);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_GRADE_H_
