#include "io/config/vehicle.h"

#include <gmock/gmock.h>

#include "io/sample_folder.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kImuOfAVehicle =
    "imu:\n  file: imu.csv\n"
    "  noise: {gyro: 0.2 deg/sqrt(h), accel: 70 ug/sqrt(Hz)}\n";

class VehicleTest : public SampleFolder {
 protected:
  VehicleTest() { Write("imu.csv", kRestingImu); }
  Dataset Of(const std::string& keys) {
    Write("config.yaml", kImuOfAVehicle + keys);
    return Load(&resolved_);
  }
  ResolvedConfig resolved_;
};

TEST_F(VehicleTest, SetsWhatIsNotGiven) {
  const Dataset none = Of("");
  EXPECT_FALSE(none.stationary.enabled);
  EXPECT_TRUE(none.streams.empty());
  EXPECT_EQ(none.initial.speed_spread, 10.0);
  const Dataset car = Of("vehicle: car\n");
  EXPECT_TRUE(car.stationary.enabled);
  ASSERT_EQ(car.streams.size(), 2u);
  EXPECT_EQ(car.streams[0].sensor.name, "wheels");
  EXPECT_EQ(car.streams[1].sensor.name, "wheels_level");
  EXPECT_EQ(car.initial.speed_spread, 15.0);
  EXPECT_THAT(resolved_.yaml, HasSubstr("vehicle: car"));
  EXPECT_THAT(resolved_.yaml, HasSubstr("type: non_holonomic"));
  ASSERT_FALSE(car.notes.empty());
  EXPECT_THAT(car.notes[0], HasSubstr("vehicle car sets stationary: on; "
                                      "aiding.wheels: {type: non_holonomic"));
  // What was resolved is the same again.
  Write("config.yaml", resolved_.yaml);
  EXPECT_EQ(Load().streams.size(), 2u);
}

TEST_F(VehicleTest, AGivenKeyGoesBefore) {
  const Dataset car =
      Of("vehicle: car\nstationary: off\ninitial: {speed_spread: 3 m/s}\n"
         "aiding:\n  own: {type: non_holonomic, rate: 2 Hz, sigma: [0.1, 0.1 "
         "m/s]}\n");
  EXPECT_FALSE(car.stationary.enabled);
  EXPECT_EQ(car.initial.speed_spread, 3.0);
  ASSERT_EQ(car.streams.size(), 1u);
  EXPECT_EQ(car.streams[0].sensor.name, "own");
  EXPECT_THAT(car.notes[0],
              HasSubstr("sets nothing; the configuration has its own of "
                        "stationary; aiding.wheels; initial.speed_spread"));
}

TEST_F(VehicleTest, AStreamThatIsCalledWheelsIsNoConstraint) {
  Write("speed.csv", "t[s],v_n[m/s],v_e[m/s],v_d[m/s]\n0,0,0,0\n1,0,0,0\n");
  const Dataset car =
      Of("vehicle: car\naiding:\n"
         "  wheels: {type: velocity, file: speed.csv, sigma: 0.1 m/s}\n");
  ASSERT_EQ(car.streams.size(), 3u);
  EXPECT_EQ(car.streams[0].sensor.name, "wheels");
  EXPECT_EQ(car.streams[1].sensor.name, "wheels_2");
  EXPECT_EQ(car.streams[1].sensor.kind, &NonHolonomicKind());
  EXPECT_THAT(car.notes.at(0),
              HasSubstr("; aiding.wheels_2: {type: non_holon"));
  // What was resolved is the same again.
  Write("config.yaml", resolved_.yaml);
  EXPECT_EQ(Load().streams.size(), 3u);
}

TEST_F(VehicleTest, EveryKindLoads) {
  for (const std::string& name : VehicleNames()) {
    const Dataset data = Of("vehicle: " + name + "\n");
    EXPECT_THAT(data.notes.at(0), HasSubstr("vehicle " + name + " sets "));
    const bool wheels = name == "car" || name == "rail";
    EXPECT_EQ(data.streams.size(), wheels ? 2u : 0u) << name;
    EXPECT_EQ(data.stationary.enabled, wheels || name == "foot") << name;
  }
  Write("config.yaml", std::string(kImuOfAVehicle) + "vehicle: bicycle\n");
  EXPECT_THAT(LoadError(), HasSubstr("config.yaml:4: vehicle: "));
  EXPECT_THAT(LoadError(), HasSubstr("underwater"));
}

}  // namespace
}  // namespace hindsight
