#ifndef HINDSIGHT_TESTS_RECEIVER_ERRORS_RECEIVER_TAPE_H_
#define HINDSIGHT_TESTS_RECEIVER_ERRORS_RECEIVER_TAPE_H_

#include "filters/forward_filter.h"
#include "receiver_errors/mode_sequence.h"
#include "support/test_problem.h"

namespace hindsight::testing {

/// Of a drive with positions alone, of `sigma` [m] an axis, in which nothing errs.
inline TestProblemOptions OfPositions(double duration, double sigma) {
  TestProblemOptions options;
  options.noise = TacticalNoise(true);
  options.layout = TypicalLayout(options.noise);
  options.duration = duration;
  options.position_sigma = sigma;
  options.velocity_sigma = 0.0;
  return options;
}

/// A drive with positions alone, of 0.5 m an axis, with errors of everything.
inline TestProblem PositionsOnly(double duration, double spacing = 1.0,
                                 std::uint64_t seed = 3) {
  TestProblemOptions options = OfPositions(duration, 0.5);
  options.errors = true;
  options.spacing = spacing;
  return MakeProblem(options, seed);
}

inline LinearTape TapeOf(const TestProblem& problem, GateDecisions used = {}) {
  if (used.empty()) used.assign(problem.measurements.size(), 1);
  Problem posed = problem.Pose(std::move(used));
  return RunLinearizedFilter(problem.truth, &posed);
}

/// Adds an error [m], NED, to the fixes first to past the last.
inline void AddError(std::size_t begin, std::size_t end,
                     const Eigen::Vector3d& e_n, TestProblem* problem) {
  for (std::size_t k = begin; k < end; ++k) {
    auto& fix = std::get<PositionFix>(problem->measurements[k].model);
    fix.p_e += NedAxes(fix.p_e) * e_n;
  }
}

inline ModeSequence Good(const LinearTape& tape) {
  std::size_t fixes = 0;
  for (std::size_t k = 0; k < tape.size(); ++k) fixes += HasFix(tape, k, 0);
  return ModeSequence(fixes);
}

inline ErrorParameters WithoutOutliers() {
  ErrorParameters p;
  p.outlier_share = 0.0;
  p.sigma = 10.0;
  p.tau = 1e8;
  p.slight_tau = 1e8;
  return p;
}

}  // namespace hindsight::testing

#endif  // HINDSIGHT_TESTS_RECEIVER_ERRORS_RECEIVER_TAPE_H_
