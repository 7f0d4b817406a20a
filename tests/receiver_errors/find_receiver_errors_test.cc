#include <fmt/core.h>
#include <gmock/gmock.h>

#include <chrono>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "base/parallel.h"
#include "base/random.h"
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
using ::testing::StartsWith;
using testing::TestProblem;
using testing::TestProblemOptions;

/// Half a minute of positions and velocities, of which the velocities are asked first.
TestProblem OfTwoSensors() {
  TestProblemOptions options = OfPositions(30.0, 0.5);
  options.velocity_sigma = 0.05;
  return MakeProblem(options, 3);
}

/// Of the same fixes, with noise of its own.
void AddSecondReceiver(TestProblem* test) {
  Random random(4);
  const auto second = static_cast<int>(test->sensors.size());
  test->sensors.push_back(test->sensors.front());
  std::vector<Measurement> all;
  for (Node& node : test->nodes) {
    const auto from = test->measurements.begin() + node.first_measurement;
    node.first_measurement = static_cast<int>(all.size());
    for (auto z = from; z != from + node.measurement_count; ++z) {
      all.push_back(*z);
      if (!std::holds_alternative<PositionFix>(z->model)) continue;
      all.push_back(*z);
      all.back().sensor = second;
      std::get<PositionFix>(all.back().model).p_e +=
          0.5 * random.NormalVector3();
    }
    node.measurement_count =
        static_cast<int>(all.size()) - node.first_measurement;
  }
  test->measurements = std::move(all);
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

/// Two receivers and a sensor of velocities, of which one receiver is off for ten seconds.
TEST(FindReceiverErrors, FindsTheSameSideBySide) {
  TestProblemOptions options = OfPositions(40.0, 0.5);
  options.velocity_sigma = 0.05;
  TestProblem test = MakeProblem(options, 3);
  AddSecondReceiver(&test);
  for (Measurement& z : test.measurements) {
    auto* fix = std::get_if<PositionFix>(&z.model);
    if (fix != nullptr && z.sensor == 0 && z.t > 15.5 && z.t < 25.5) {
      fix->p_e += NedAxes(fix->p_e) * Eigen::Vector3d(20.0, 0.0, 0.0);
    }
  }
  Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  const int before = ThreadCount();
  std::vector<std::vector<std::string>> told;
  for (const int threads : {1, 3}) {
    SetThreadCount(threads);
    told.emplace_back();
    for (const ReceiverErrors& one :
         FindReceiverErrors(problem, tape, {.share = 0.02})) {
      told.back().push_back(fmt::format("{} {} {}", one.sensor(),
                                        one.log_gain(),
                                        one.Stands() ? one.InWords() : ""));
    }
  }
  SetThreadCount(before);
  ASSERT_EQ(told[0].size(), 3u);
  EXPECT_THAT(told[0][0], StartsWith("0 "));
  EXPECT_EQ(told[0], told[1]);
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
