#include "dataset/mirrored_axis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/config/scenario_config.h"
#include "measurements/sensor_kind.h"
#include "simulation/scenario.h"
#include "simulation/wandering_drive.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;

Dataset DriveSeenBy(const SensorKind& kind, double sigma) {
  Scenario scenario = FindScenario("short_drive");
  scenario.segments = WanderingDrive(180.0, 31);
  AidingModel model(kind);
  model.sensor.name = "seen";
  model.sigma = Eigen::Vector3d::Constant(sigma);
  model.rate_hz = 5.0;
  scenario.aiding = {model};
  return Simulate(scenario, 31);
}

void TurnRound(int axis, bool accel, Dataset* dataset) {
  for (ImuSample& sample : dataset->imu.samples) {
    sample.gyro(axis) = -sample.gyro(axis);
    if (accel) sample.accel(axis) = -sample.accel(axis);
  }
}

TEST(OtherHand, AnAxisThatIsMirroredIsToldFromGyrosOfTheOtherSign) {
  for (const auto& [kind, sigma] :
       {std::pair(&PositionKind(), 0.05), {&VelocityKind(), 0.05}}) {
    const Dataset as_it_is = DriveSeenBy(*kind, sigma);
    EXPECT_FALSE(FindOtherHand(as_it_is)) << kind->name;
    for (const int axis : {0, 1}) {
      Dataset mirrored = as_it_is;
      TurnRound(axis, true, &mirrored);
      const auto found = FindOtherHand(mirrored);
      ASSERT_TRUE(found) << kind->name << " " << axis;
      EXPECT_EQ(found->stream, "seen");
      EXPECT_LT(found->mirrored, found->reversed);
      EXPECT_THAT(Describe(*found), HasSubstr("an axis is mirrored"));
    }
    Dataset reversed = as_it_is;
    for (const int axis : {0, 1, 2}) TurnRound(axis, false, &reversed);
    const auto found = FindOtherHand(reversed);
    ASSERT_TRUE(found) << kind->name;
    EXPECT_LT(found->reversed, found->mirrored);
    EXPECT_THAT(Describe(*found), HasSubstr("the gyros have the other sign"));
  }
}

}  // namespace
}  // namespace hindsight
