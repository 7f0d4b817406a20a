#ifndef HINDSIGHT_PROBLEMS_GRADE_TRIAL_H_
#define HINDSIGHT_PROBLEMS_GRADE_TRIAL_H_

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "problems/montecarlo.h"
#include "problems/navigation_trial.h"

namespace hindsight {

/// A recording made wrong in one way and size.
struct FaultyTwin {
  std::string fault;
  std::string size;
  std::function<void(std::uint64_t seed, Dataset*)> apply;
  /// From the healthy recording, the faulty one with its errors where they were
  /// in the healthy one, by which the fault is measured; nothing where `apply`
  /// leaves them there.
  std::function<std::optional<Dataset>(std::uint64_t seed, const Dataset&)>
      with_errors_kept = nullptr;
};

/// A mean NEES of three components above this is wrong; right is 3.
inline constexpr double kWrongNees = 25.0;
/// So is a larger share of the time outside of 5 sigmas of a component.
inline constexpr double kWrongShare = 0.05;

/// How far the innovations of a faulty recording are from those of its healthy
/// twin, which has the same noise in the same places: the root of the
/// noncentrality that the states could not take up. A test of one given deviation with a false alarm
/// rate of 0.1 % has a power of 99 % at kVisible = 3.29 + 2.33 (Baarda 1968).
/// Infinite if there is no common measurement.
double Noncentrality(const std::vector<NormalisedInnovation>& healthy,
                     const std::vector<NormalisedInnovation>& faulty);
inline constexpr double kVisible = 5.62;

/// How grades hold against recordings that are wrong. Tables:
///   0 summary   vehicle, class, method: grades. Classes: "healthy"; "healthy,
///               wrong"; of faulty ones "no answer" (refused, or without a
///               solution), "right", "wrong, visible", "wrong, not visible"
///   1 faults    vehicle, fault, size, method: grades, and of which the answer
///               is wrong, and the fault visible
///   2 evidence  vehicle, rule, method: in how many wrong, visible runs the
///               rule lowered the grade, in how many alone, and in how many
///               healthy ones
/// Beside the methods each has what `run` with all of them ends with, the row
/// kBestOfRun.
std::vector<StudyTable> GradeTables();

/// Tries a healthy recording, and its twin with every fault: the last label of
/// the case is the vehicle. The nodes are judged as `trial` says.
Trial GradeTrial(const NavigationTrial& trial,
                 const std::vector<FaultyTwin>& twins);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_GRADE_TRIAL_H_
