#include "evaluation/grade.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "evaluation/trajectory_error.h"
#include "geometry/so3.h"
#include "io/config/scenario_config.h"
#include "measurements/sensor_kind.h"
#include "problems/reconstruction.h"
#include "support/in_flight.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::vector<std::string> KeptAtPriors(const Solution& solution) {
  std::vector<std::string> names;
  for (const ConstantEstimate& c : solution.constants) {
    if (c.verdict == ConstantEstimate::Verdict::kUnobserved) {
      names.push_back(c.name);
    }
  }
  return names;
}

bool HasRule(const Solution& solution, const std::string& rule) {
  return std::any_of(solution.evidence.begin(), solution.evidence.end(),
                     [&](const Evidence& e) { return e.rule == rule; });
}

TEST(Verdict, CountsTheConstantsThatStayAtTheirPriors) {
  const Dataset dataset = Simulate(InFlightAlignment(), 1);
  ReconstructionOptions options;
  options.to = kFirstManoeuvre + 2.0;
  Reconstruction reconstruction(dataset, options);
  for (const std::string method : {"ekf", "batch"}) {
    const Solution solution = reconstruction.Run(method);
    const std::vector<std::string> names = KeptAtPriors(solution);
    ASSERT_GT(names.size(), 1u);
    ASSERT_LE(names.size(), 6u);
    const std::string expected = "; " + std::to_string(names.size()) +
                                 " constants are kept at their priors";
    EXPECT_THAT(solution.verdict, StartsWith("usable: position to "));
    EXPECT_THAT(solution.verdict, HasSubstr(expected));
  }
}

TEST(Verdict, SaysNothingOfConstantsWhereAllAreObserved) {
  const Dataset dataset = Simulate(InFlightAlignment(), 1);
  const Solution solution = Solve(dataset, {});
  EXPECT_TRUE(KeptAtPriors(solution).empty());
  EXPECT_EQ(solution.grade, Grade::kUsable) << solution.verdict;
  EXPECT_EQ(solution.verdict.find("prior"), std::string::npos);
}

/// One minute of the car drive.
Dataset GradedDrive(std::uint64_t seed = 1) {
  Scenario scenario = FindScenario("car_drive");
  scenario.duration = 60.0;
  scenario.withholdings.clear();
  return Simulate(scenario, seed);
}

TEST(Grade, StartThatWasGivenWronglyIsDoubtfulAndNamed) {
  Dataset dataset = GradedDrive();
  const Solution right = Solve(dataset, {});
  EXPECT_EQ(right.grade, Grade::kUsable) << right.verdict;
  dataset.initial.alignment = AlignmentKind::kGiven;
  dataset.initial.euler = EulerFromQuaternion(*dataset.truth.front().q_nb);
  dataset.initial.attitude_sigma = Eigen::Vector3d(1.0, 1.0, 3.0) * kDegree;
  EXPECT_EQ(Solve(dataset, {}).grade, Grade::kUsable);
  dataset.initial.euler->z() += 30.0 * kDegree;
  const Solution wrong = Solve(dataset, {});
  EXPECT_EQ(wrong.grade, Grade::kDoubtful) << wrong.verdict;
  EXPECT_TRUE(HasRule(wrong, "given_values"));
  EXPECT_THAT(wrong.verdict, HasSubstr("attitude[down]"));
  EXPECT_THAT(wrong.verdict, HasSubstr("from its given value"));
}

TEST(Grade, ImuThatFreezesIsDoubtful) {
  Dataset dataset = GradedDrive();
  const ImuSample* held = nullptr;
  for (ImuSample& sample : dataset.imu.samples) {
    if (sample.t < 30.0 || sample.t > 35.0) continue;
    if (held == nullptr) held = &sample;
    sample.gyro = held->gyro;
    sample.accel = held->accel;
  }
  const Solution solution = Solve(dataset, {});
  EXPECT_NE(solution.grade, Grade::kUsable) << solution.verdict;
  EXPECT_TRUE(HasRule(solution, "frozen_imu"));
}

TEST(Grade, PositionsThatRepeatAreNotUsable) {
  Dataset dataset = GradedDrive();
  for (AidingStream& stream : dataset.streams) {
    if (!stream.sensor.kind->is_position) continue;
    MeasurementSeries written;
    for (const Measurement& z : stream.measurements) {
      for (int i = 0; i < 25; ++i) {
        written.push_back({z.t + 0.04 * i, z.sensor, z.withheld, z.model});
      }
    }
    stream.measurements = std::move(written);
  }
  const Solution solution = Solve(dataset, {});
  EXPECT_EQ(solution.grade, Grade::kUnusable) << solution.verdict;
  EXPECT_TRUE(HasRule(solution, "stale_readings"));
}

/// Surveys whose odometer counts forward alone leave the start's attitude and
/// the sideways motion to the linearisation, which is often too far off for one
/// pass. What is called usable is as wrong as its sigmas say: the mean over the
/// interval of three squares of errors that all last as long as the interval is
/// below 21.1 in all but one of ten thousand runs.
TEST(Grade, NoSurveyWithAForwardOdometerIsWrongAndUsable) {
  constexpr double kOnceInTenThousand = 21.1;  // chi-square of 3
  constexpr const char* kMethods[] = {"ekf", "rts", "two_filter", "iterated"};
  int refused = 0;
  for (const char* path : {"winding", "straight"}) {
    for (const char* noise : {"sample", "density"}) {
      const Scenario survey =
          FindScenario("tunnel_survey", {std::string("path=") + path,
                                         std::string("noise=") + noise,
                                         "aiding.odometer.form=forward"});
      constexpr std::uint64_t seed = 101;
      Dataset dataset = Simulate(survey, seed);
      // At the nodes, so that nothing is interpolated.
      dataset.truth.EraseIf([](const TruthPoint& point) {
        return point.t != std::round(point.t);
      });
      Reconstruction reconstruction(dataset, {});
      for (const std::string method : kMethods) {
        const Solution solution = reconstruction.Run(method);
        const TrajectoryStatistics errors =
            EvaluateTrajectory(TableFromSolution(solution), dataset.truth, {});
        SCOPED_TRACE(::testing::Message()
                     << method << " on " << path << ", seed " << seed << ": "
                     << solution.verdict);
        EXPECT_TRUE(solution.usable() || method != "iterated");
        if (!solution.usable()) {
          ++refused;
          continue;
        }
        EXPECT_LT(*errors.position_nees, kOnceInTenThousand);
        EXPECT_LT(*errors.velocity_nees, kOnceInTenThousand);
        EXPECT_LT(*errors.attitude_nees, kOnceInTenThousand);
      }
    }
  }
  // Else the test would say nothing.
  EXPECT_GE(refused, 4);
}

}  // namespace
}  // namespace hindsight
