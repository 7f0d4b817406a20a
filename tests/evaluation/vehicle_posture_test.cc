#include "evaluation/vehicle_posture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/units.h"
#include "measurements/sensor_kind.h"
#include "support/test_motion.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;

/// A car with a wheel that goes north at 10 m/s for 50 s.
class VehiclePosture : public ::testing::Test {
 protected:
  VehiclePosture() {
    solution_.layout = testing::TypicalLayout();
    sensors_[0].name = "gnss";
    sensors_[0].kind = &PositionKind();
    sensors_[1].name = "wheel";
    for (const SensorKind* kind : SensorKinds()) {
      if (kind->name == "odometer") sensors_[1].kind = kind;
    }
  }

  std::vector<Evidence> Drive(double roll, double heading, double duration) {
    solution_.states.clear();
    for (int k = 0; k <= static_cast<int>(duration); ++k) {
      solution_.states.push_back(MakeState(
          k, {48.0 * kDegree, 11.0 * kDegree, 500.0}, {10.0, 0.0, 0.0},
          {roll * kDegree, 0.0, heading * kDegree}));
    }
    std::vector<Evidence> evidence;
    FindOddPosture({.solution = solution_, .sensors = sensors_}, &evidence);
    return evidence;
  }

  Solution solution_;
  std::vector<Sensor> sensors_ = std::vector<Sensor>(2);
};

TEST_F(VehiclePosture, OfACarThatDrivesAsCarsDoIsNotOdd) {
  EXPECT_TRUE(Drive(0.0, 0.0, 50.0).empty());
  EXPECT_TRUE(Drive(-80.0, 0.0, 50.0).empty());
  EXPECT_TRUE(Drive(0.0, 80.0, 50.0).empty());
}

TEST_F(VehiclePosture, OnItsRoofIsDoubtful) {
  const std::vector<Evidence> evidence = Drive(180.0, 0.0, 50.0);
  ASSERT_EQ(evidence.size(), 1u);
  EXPECT_EQ(evidence[0].grade, Grade::kDoubtful);
  EXPECT_TRUE(evidence[0].is_cause);
  EXPECT_THAT(evidence[0].what,
              HasSubstr("the vehicle of wheel stands on its roof at 100 %"));
}

TEST_F(VehiclePosture, BackwardsAllTheWayIsDoubtfulIfItIsLong) {
  EXPECT_TRUE(Drive(0.0, 180.0, 9.0).empty());
  const std::vector<Evidence> evidence = Drive(0.0, 180.0, 50.0);
  ASSERT_EQ(evidence.size(), 1u);
  EXPECT_THAT(evidence[0].what, HasSubstr("drives backwards on 100 %"));
}

TEST_F(VehiclePosture, IsThatOfTheVehicleNotOfTheImu) {
  sensors_[1].q_sb = Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX());
  EXPECT_TRUE(Drive(180.0, 0.0, 50.0).empty());
  EXPECT_EQ(Drive(0.0, 0.0, 50.0).size(), 1u);
}

TEST_F(VehiclePosture, OfWhatHasNoWheelsIsAny) {
  sensors_.pop_back();
  EXPECT_TRUE(Drive(180.0, 180.0, 50.0).empty());
}

}  // namespace
}  // namespace hindsight
