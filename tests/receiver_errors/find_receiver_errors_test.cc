#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

#include "filters/forward_filter.h"
#include "receiver_errors/receiver_errors.h"
#include "receiver_errors/receiver_tape.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
using testing::MakeProblem;
using testing::OfPositions;
using testing::TestProblem;
using testing::TestProblemOptions;

/// Half a minute of positions and velocities, of which the velocities are asked first.
TestProblem OfTwoSensors() {
  TestProblemOptions options = OfPositions(30.0, 0.5);
  options.velocity_sigma = 0.05;
  return MakeProblem(options, 3);
}

TEST(FindReceiverErrors, HasTimeForEachSensor) {
  const TestProblem test = OfTwoSensors();
  Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  const steady_clock::time_point until =
      steady_clock::now() + milliseconds(400);
  int steps_of_second = 0;
  const std::vector<ReceiverErrors> found = FindReceiverErrors(
      problem, tape,
      {.go_on =
           [&](double fraction) {
             const bool in_time = steady_clock::now() < until;
             steps_of_second += in_time && fraction > 0.5;
             // Neither comes to its end.
             std::this_thread::sleep_for(milliseconds(2));
             return in_time;
           },
       .until = until});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_TRUE(found[0].WasEnded());
  EXPECT_TRUE(found[1].WasEnded());
  EXPECT_GT(steps_of_second, 1);
}

/// Which one is blamed would hang on what the fits begin from.
TEST(FindReceiverErrors, BlamesNoneOfSeveralWhoseErrorsWereNotFitted) {
  TestProblem test = OfTwoSensors();
  for (Measurement& z : test.measurements) {
    auto* fix = std::get_if<PositionFix>(&z.model);
    if (fix != nullptr && z.t > 15.5) {
      fix->p_e += NedAxes(fix->p_e) * Eigen::Vector3d(20.0, 0.0, 0.0);
    }
  }
  Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  const auto stands = [&](bool goes_on) {
    int count = 0;
    for (const ReceiverErrors& one : FindReceiverErrors(
             problem, tape, {.go_on = [=](double) { return goes_on; }})) {
      count += one.Stands();
    }
    return count;
  };
  EXPECT_GT(stands(true), 0);
  EXPECT_EQ(stands(false), 0);
}

}  // namespace
}  // namespace hindsight
