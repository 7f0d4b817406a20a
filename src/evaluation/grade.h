#ifndef HINDSIGHT_EVALUATION_GRADE_H_
#define HINDSIGHT_EVALUATION_GRADE_H_

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dataset/dataset.h"
#include "state/solution.h"

namespace hindsight {

/// A systematic error of b standard deviations that sigma does not cover leaves
/// root mean square errors of sqrt(1 + b^2) sigma. At one sigma these are 1.4
/// times as large as stated; at three, the truth is outside of the 3-sigma
/// interval half of the time.
inline constexpr double kDoubtfulBias = 1.0;  // sigma
inline constexpr double kUnusableBias = 3.0;  // sigma

/// What an estimate started from, and how it came about.
struct StartValues {
  State x;
  ErrorMatrix P;  ///< over the solution's layout
  /// What the configuration says; the rest the program chose itself.
  InitialState given;
  std::string position;   ///< in words: "position fix at t = 3.00 s"
  std::string alignment;  ///< name of the method that chose the attitude
};

/// How far a solution moves where the whole interval is linearised anew about
/// it: the largest distance of a component of position, velocity or attitude at
/// any epoch, in the solution's own standard deviations.
struct LinearisationMove {
  double sigmas = 0.0;  ///< infinity if no new linearisation holds
  std::string component;
  double t = 0.0;        ///< [s]
  bool settled = false;  ///< linearised again, the interval moves no farther
};

/// What the rules look at.
struct Judged {
  const Solution& solution;
  std::span<const Sensor> sensors = {};
  std::optional<StartValues> start = std::nullopt;
  std::optional<LinearisationMove> move = std::nullopt;
  /// Sensor whose estimated time offset goes on moving; empty: none.
  std::string unsettled = "";
  /// What the recording shows by itself, of the solution's interval.
  std::vector<Evidence> recording = {};
  /// Nothing says where north is: the heading counts from the start.
  bool relative_heading = false;
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

/// Takes out of every solution's evidence the advice to take a method that is
/// itself among the solutions and has no better grade.
void KeepBetterMethods(std::vector<Solution>* solutions);

/// Index of the best of several solutions of one recording: the best grade; of
/// equal ones the least evidence against it; then the order of `preference`,
/// the names of methods, best first. No truth is looked at. -1 if there are
/// none.
int BestOf(const std::vector<Solution>& solutions,
           std::span<const char* const> preference);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_GRADE_H_
