#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "base/units.h"
#include "evaluation/agreement.h"
#include "evaluation/contradicted_sensor.h"
#include "evaluation/innovation_rule.h"
#include "io/config/scenario_config.h"
#include "problems/reconstruction.h"
#include "simulation/fault.h"
#include "simulation/scenario.h"

namespace hindsight {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

struct FaultOf {
  const char* vehicle;
  const char* fault;
  const char* sensor;
  double size;  ///< SI
};

std::vector<std::string> Contradictions(const FaultOf& c) {
  Dataset dataset = Simulate(FindScenario(c.vehicle, {}), 11);
  ApplyFault({FindFaultKind(c.fault), c.sensor, c.size}, 11, &dataset);
  std::vector<std::string> all;
  for (const Evidence& evidence :
       Reconstruction(dataset, {}).Run("batch").evidence) {
    if (evidence.rule == "contradiction") all.push_back(evidence.what);
  }
  return all;
}

/// Position, depth and DVL: two are left to say which.
TEST(Contradiction, NamesTheSensorThatTheOthersContradict) {
  EXPECT_THAT(Contradictions({"test_dive", "lasting", "dvl", 0.03}),
              Contains(HasSubstr("all else fits without dvl, which it")));
}

TEST(Contradiction, OfAnOdometerWithAnotherScaleNamesIt) {
  EXPECT_THAT(Contradictions({"test_car", "scale", "odometer", 1.05}),
              Contains(HasSubstr("all else fits without odometer, which it")));
}

/// What it costs at the beginning is no reason not to use what follows.
TEST(Contradiction, AStartTurnedRoundIsNamedAndTheRestUsed) {
  Dataset dataset = Simulate(FindScenario("test_aircraft", {}), 11);
  ApplyFault({FindFaultKind("start_heading"), "", kPi}, 11, &dataset);
  const Solution run = Reconstruction(dataset, {}).Run("batch");
  EXPECT_EQ(GradeOf(run.evidence), Grade::kDoubtful);
  EXPECT_THAT(
      run.evidence,
      Contains(Field(&Evidence::what,
                     HasSubstr("all else fits without the a priori values"))));
}

/// Without the fixes nothing sees the heading, so that all would fit: it is not
/// the receiver all the same.
TEST(Contradiction, AnErrorOfTheImuIsNoSensors) {
  EXPECT_THAT(Contradictions({"test_aircraft", "gyro_step", "", 3.5e-4}),
              Not(Contains(HasSubstr("which it contradicts"))));
}

struct JudgedSensors {
  std::vector<Sensor> sensors;
  Solution solution;
  LeftOutSensor left_out;
  std::vector<InnovationFigure> figures;

  JudgedSensors() : sensors(2), figures(1) {
    sensors[0].name = "gnss";
    sensors[1].name = "odometer";
    figures[0].sensor = 1;
    figures[0].excess = 10.0;
    left_out = {.sensors = {"odometer"},
                .misfit = 3.0,
                .onset = std::nullopt,
                .effect = 0.5};
  }
  Judged AsJudged() const {
    return {.solution = solution,
            .sensors = sensors,
            .innovations = figures,
            .contradiction = &left_out};
  }
  Grade OfInnovations() const {
    std::vector<Evidence> evidence;
    FindOddInnovations(AsJudged(), &evidence);
    EXPECT_THAT(evidence, SizeIs(1));
    return GradeOf(evidence);
  }
};

TEST(Contradiction, OnlyASensorThatIsAloneAndHardlyCountsIsOutvoted) {
  JudgedSensors judged;
  EXPECT_TRUE(IsOutvoted(judged.AsJudged(), "odometer"));
  EXPECT_FALSE(IsOutvoted(judged.AsJudged(), "gnss"));
  EXPECT_EQ(judged.OfInnovations(), Grade::kDoubtful);
  judged.left_out.effect = 1.01 * kUnusableBias;
  EXPECT_FALSE(IsOutvoted(judged.AsJudged(), "odometer"));
  EXPECT_EQ(judged.OfInnovations(), Grade::kUnusable);
  judged.left_out.effect = 0.5;
  judged.left_out.sensors = {kPriorValues};
  EXPECT_TRUE(IsOutvoted(judged.AsJudged(), "gnss"));
  EXPECT_EQ(judged.OfInnovations(), Grade::kDoubtful);
  judged.left_out.sensors = {"gnss", "odometer"};
  EXPECT_FALSE(IsOutvoted(judged.AsJudged(), "odometer"));
  EXPECT_EQ(judged.OfInnovations(), Grade::kUnusable);
}

TEST(Contradiction, OfTwoNamesBoth) {
  JudgedSensors judged;
  judged.left_out.sensors = {"gnss", "odometer"};
  std::vector<Evidence> evidence;
  FindContradictedSensor(judged.AsJudged(), &evidence);
  ASSERT_THAT(evidence, SizeIs(1));
  EXPECT_THAT(evidence.front().what,
              AllOf(HasSubstr("without gnss or odometer"),
                    HasSubstr("they contradict each other")));
  EXPECT_EQ(GradeOf(evidence), Grade::kDoubtful);
}

TEST(Innovations, ThatCouldNotBeTestedAreDoubtful) {
  const Solution solution;
  std::vector<Evidence> evidence;
  FindOddInnovations({.solution = solution}, &evidence);
  EXPECT_THAT(evidence, IsEmpty());
  FindOddInnovations({.solution = solution, .untested = true}, &evidence);
  EXPECT_EQ(GradeOf(evidence), Grade::kDoubtful);
}

TEST(Agreement, IsDoubtedFromTheLimitOn) {
  const Solution solution;
  const auto grade = [&](double distance) {
    const std::vector<AgreementFigure> figures = {
        {.what = "position", .t = 5.0, .distance = 1.0, .limit = 4.0},
        {.what = "attitude", .t = 7.0, .distance = distance, .limit = 3.0}};
    std::vector<Evidence> evidence;
    FindDisagreeingSides({.solution = solution, .agreement = figures},
                         &evidence);
    EXPECT_THAT(evidence, SizeIs(distance < 3.0 * kDoubtfulError ? 0 : 1));
    return GradeOf(evidence);
  };
  EXPECT_EQ(grade(0.99 * 3.0 * kDoubtfulError), Grade::kUsable);
  EXPECT_EQ(grade(1.01 * 3.0 * kDoubtfulError), Grade::kDoubtful);
}

}  // namespace
}  // namespace hindsight
