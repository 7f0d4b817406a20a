#ifndef HINDSIGHT_TESTS_BENCHMARKS_LAST_STEP_H_
#define HINDSIGHT_TESTS_BENCHMARKS_LAST_STEP_H_

namespace hindsight {

/// Root mean square a node of the step that is the last one [m, m/s, rad...].
inline constexpr double kLastStep = 1e-5;

}  // namespace hindsight

#endif  // HINDSIGHT_TESTS_BENCHMARKS_LAST_STEP_H_
