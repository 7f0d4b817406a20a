#include "app/disguised_folder.h"

#include <gmock/gmock.h>

namespace hindsight {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(DisguisedFolder, FixesWithoutSigmasAreAsNoisyAsTheyShow) {
  for (const char* scenario : {"test_car", "test_aircraft"}) {
    Simulate(scenario);
    DropSigmas("gnss.csv");
    const Outcome run = Run();
    EXPECT_EQ(run.status, 0) << scenario << "\n" << run.out << run.err;
    EXPECT_THAT(Config(), Not(HasSubstr("white: 0.1 m")));
    ExpectHonestPositions();
    std::filesystem::remove_all(folder_.path() / "data");
  }
}

TEST_F(DisguisedFolder, ABarometerKeepsItsClockAndHasADatumOfItsOwn) {
  Simulate("test_aircraft");
  const Outcome run = Run();
  EXPECT_EQ(run.status, 0) << run.out << run.err;
  const std::string config = Config();
  const std::string height =
      config.substr(config.find("  height:"), config.find("  position:"));
  EXPECT_THAT(config, Not(HasSubstr("time_offset: unknown")));
  EXPECT_THAT(height, HasSubstr("estimate: {offset: 50 m}"));
  ExpectHonestPositions();
}

TEST_F(DisguisedFolder, VelocitiesAloneStartWhereTheTruthDoes) {
  Simulate("test_aircraft");
  for (const char* name : {"gnss.csv", "barometer.csv"}) {
    std::filesystem::remove(file(name));
  }
  // Without a truth the place is a local one, and said to be.
  const Outcome local = Run();
  EXPECT_THAT(local.out, HasSubstr("no stream tells the position"));
  EXPECT_THAT(local.out, HasSubstr("initial.position"));
  Table truth = ReadTable(folder_.path() / "truth.csv");
  for (auto& row : truth) row.resize(4);
  WriteTable(file("truth.csv"), truth);
  const Outcome run = Run();
  EXPECT_EQ(run.status, 0) << run.out << run.err;
  EXPECT_THAT(run.out, HasSubstr("the truth's first is the start"));
  EXPECT_THAT(Config(), HasSubstr("position: [48.000000000 deg, 11.500000000 "
                                  "deg, 1500.000 m]"));
  ExpectHonestPositions();
}

TEST_F(DisguisedFolder, AMirroredAxisIsNamedAndNothingIsUsable) {
  for (const char* scenario : {"test_car", "test_aircraft", "test_hand"}) {
    Simulate(scenario);
    MirrorImu();
    const Outcome run = Run();
    EXPECT_NE(run.status, 0) << scenario << "\n" << run.out;
    EXPECT_THAT(run.out, HasSubstr("imu: an axis is mirrored")) << scenario;
    std::filesystem::remove_all(folder_.path() / "data");
  }
}

}  // namespace
}  // namespace hindsight
